// ---- Marks: nodes and their labels ---------------------------------------------------------------

/** Directions in which labels stand, in eighths of a turn from the right, the best first. */
const LABEL_DIRECTIONS = [1, 7, 0, 2, 3, 5, 4, 6];
/** How far a label stands from its mark, in pixels; the nearer, the better. */
const LABEL_GAPS = [0, 6];
/** What a label pays for each end on a wall and for each edge below it, and what it saves by staying in its direction. */
const WALL_PRICE = 30, EDGE_PRICE = 8, LOYALTY = 12;
/** White between labels, in pixels. */
const LABEL_AIR = 2;

/** The share of a label that may lie on others before one that is of little use is left out. */
const MOST_COVERED = 0.3;

/** Writes labels, each in the best direction; a label keeps its direction where it can. */
class LabelPlaces {
  constructor() {
    this.directions = new Map();
    /** What was drawn last: keys and boxes. */
    this.boxes = [];
  }

  /**
   * The labels in the order of their importance. A label has a `text`, a `key` that stays the same, a
   * `spot`, how far away it stands, and whether it `mayGo` where there is no room.
   */
  draw(context, labels, floor, edges, radius) {
    const taken = labels.map(({ spot: [x, y] }) => [x - radius, y - radius, x + radius, y + radius]);
    const size = labels.length > 36 ? 9.5 : 11;
    context.save();
    context.font = `600 ${size}px ${colours.get("font")}`;
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.lineJoin = "round";
    context.lineWidth = 3;
    context.strokeStyle = colours.get("floor");
    this.boxes = [];
    for (const label of labels) {
      const half = [context.measureText(label.text).width / 2 + LABEL_AIR, size * 0.45];
      let best = { price: Infinity };
      for (const gap of LABEL_GAPS) {
        LABEL_DIRECTIONS.forEach((direction, rank) => {
          const place = this.placed(label, half, direction, gap), [left, top, right, foot] = place.box;
          const covered = taken.reduce((sum, other) => sum + overlap(place.box, other), 0);
          const loyalty = this.directions.get(label.key) === direction ? LOYALTY : 0;
          let price = covered + rank + gap - loyalty;
          if (price >= best.price) return;
          price += EDGE_PRICE * edges.filter(edge => crosses(edge, place.box)).length;
          for (const x of [left, right]) {
            const end = [x, (top + foot) / 2].map(length => length * devicePixelRatio);
            if (!context.isPointInPath(floor, ...end, "evenodd")) price += WALL_PRICE;
          }
          if (price < best.price) best = { ...place, direction, covered, price };
        });
      }
      if (label.mayGo && best.covered > MOST_COVERED * 4 * half[0] * half[1]) continue;
      this.directions.set(label.key, best.direction);
      taken.push(best.box);
      this.boxes.push([label.key, best.box]);
      context.strokeText(label.text, ...best.centre);
      context.fillStyle = colours.get(label.colour);
      context.fillText(label.text, ...best.centre);
    }
    context.restore();
  }

  /** Where a label stands in a direction, beyond a gap. */
  placed({ spot: [x, y], reach }, half, direction, gap) {
    const angle = direction * Math.PI / 4, away = reach + gap;
    const cx = x + Math.cos(angle) * (away + half[0]), cy = y - Math.sin(angle) * (away + half[1]);
    return { centre: [cx, cy], box: [cx - half[0], cy - half[1], cx + half[0], cy + half[1]] };
  }
}

/** The mark of a role, as large as a dot of a radius. */
function drawMark(context, { key, shape }, [x, y], radius) {
  context.beginPath();
  if (shape.polygon) {
    shape.polygon.forEach(([dx, dy], index) => context[index ? "lineTo" : "moveTo"](x + radius * dx, y + radius * dy));
    context.closePath();
  } else {
    context.arc(x, y, radius * shape.disc.radius, 0, 2 * Math.PI);
  }
  // A rim in the colour of the floor parts marks that lie on each other.
  const width = Math.min(1.1, Math.max(0.6, 0.14 * radius));
  context.strokeStyle = colours.get("floor");
  context.lineWidth = width + 2.4;
  context.stroke();
  context.fillStyle = colours.get(key);
  context.fill();
  context.strokeStyle = colours.get("outline");
  context.lineWidth = width;
  context.stroke();
  if (shape.disc?.heart) {
    context.beginPath();
    context.arc(x, y, radius * shape.disc.heart, 0, 2 * Math.PI);
    context.fillStyle = colours.get("floor");
    context.fill();
  }
}

/** Crosses out a node that does not run, whose mark is as large as a dot of a radius. */
function drawCross(context, [x, y], radius) {
  const arm = 1.7 * radius;
  context.strokeStyle = colours.get("ink");
  context.lineWidth = 2.2;
  strokeThrough(context, [[x - arm, y - arm], [x + arm, y + arm]]);
  strokeThrough(context, [[x - arm, y + arm], [x + arm, y - arm]]);
}

/** The mark of a robot that has stopped. */
function drawStopped(context, spot, radius) {
  drawMark(context, { key: "redundant", shape: { disc: { radius: 0.8 } } }, spot, radius);
  drawCross(context, spot, radius);
}

function strokeThrough(context, spots) {
  context.beginPath();
  spots.forEach((spot, index) => context[index ? "lineTo" : "moveTo"](...spot));
  context.stroke();
}

function bounds(points) {
  const low = [0, 1].map(axis => Math.min(...points.map(point => point[axis])));
  const high = [0, 1].map(axis => Math.max(...points.map(point => point[axis])));
  return { low, size: [0, 1].map(axis => high[axis] - low[axis] || 1) };
}

function overlap(one, other) {
  const along = axis => Math.max(0, Math.min(one[axis + 2], other[axis + 2]) - Math.max(one[axis], other[axis]));
  return along(0) * along(1);
}

/** Whether a straight stroke passes through a box. */
function crosses([from, to], box) {
  let enter = 0, leave = 1;
  for (const axis of [0, 1]) {
    const run = to[axis] - from[axis] || 1e-9;
    const [first, second] = [(box[axis] - from[axis]) / run, (box[axis + 2] - from[axis]) / run];
    enter = Math.max(enter, Math.min(first, second));
    leave = Math.min(leave, Math.max(first, second));
  }
  return enter <= leave;
}

/** The part of a polygon on the own side of the bisector with another robot, `clearance` from it. */
function cutAtBisector(polygon, own, other, clearance) {
  const way = [other[0] - own[0], other[1] - own[1]], length = Math.hypot(...way);
  if (length === 0) return polygon;
  const room = Math.max(0, length / 2 - clearance);
  const depth = ([x, y]) => ((x - own[0]) * way[0] + (y - own[1]) * way[1]) / length - room;
  return polygon.flatMap((corner, index) => {
    const next = polygon[(index + 1) % polygon.length], [here, there] = [depth(corner), depth(next)];
    const kept = here <= 0 ? [corner] : [];
    if (here <= 0 === there <= 0) return kept;
    const share = here / (here - there);
    return [...kept, [0, 1].map(axis => corner[axis] + share * (next[axis] - corner[axis]))];
  });
}
