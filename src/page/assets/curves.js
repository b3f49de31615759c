// ---- Curves: numbers over the run, with a cursor that follows ------------------------------------

const CHART_HEIGHT = 190;
const CHART_MARGIN = { left: 58, right: 12, top: 18, bottom: 24 };
/** Up to this many curves all are read out, and named below the panel. */
const FEW_CURVES = 3;
/** Up to this many curves each has a colour of its own. */
const DISTINCT_CURVES = 24;

/** What is selected, and what the pointer is on: a number, or null. */
class Selection {
  constructor() {
    this.chosen = null;
    this.pointed = null;
    this.listeners = [];
  }

  /** What is to be shown: what is pointed at, or else what is selected. */
  get shown() { return this.pointed ?? this.chosen; }

  choose(number) { this.set(number === this.chosen ? null : number, this.pointed); }
  point(number) { this.set(this.chosen, number); }

  set(chosen, pointed) {
    if (chosen === this.chosen && pointed === this.pointed) return;
    Object.assign(this, { chosen, pointed });
    this.listeners.forEach(listener => listener());
  }

  onChange(listener) { this.listeners.push(listener); }
}

/** The place of instants on a surface: charts and strips share it, so that they line up. */
function timeScale(player, width) {
  const { left, right } = CHART_MARGIN;
  const room = Math.max(1, width - left - right), end = Math.max(player.end, 1e-12);
  return { x: at => left + at / end * room, at: x => (x - left) / room * end };
}

/** A surface, and one over it for what changes often. On paper canvases hide what is below them, so there is one. */
function layered(parent, height, drawBase, drawTop) {
  const base = new Surface(parent, height, (context, size, isOnPaper) => {
    drawBase(context, size);
    if (isOnPaper) drawTop(context, size);
  });
  const top = new Surface(parent, height, drawTop);
  top.canvas.classList.add("over");
  return [base, top];
}

/** A press or a drag on a surface moves the run there. */
function seekOn(canvas, player) {
  const seek = event => player.seek(timeScale(player, canvas.clientWidth).at(placeOf(event)[0]));
  canvas.addEventListener("pointerdown", event => {
    canvas.setPointerCapture(event.pointerId);
    seek(event);
  });
  canvas.addEventListener("pointermove", event => { if (event.buttons & 1) seek(event); });
}

/** What colours stand for. */
function legendOf(entries) {
  const samples = entries.map(({ name, colour }) => {
    const sample = element("i");
    const paint = () => { sample.style.background = colour(); };
    theme.listeners.push(paint);
    paint();
    return element("span", {}, sample, name);
  });
  return element("p", { class: "key" }, ...samples);
}

/** The line at the current instant. */
function drawCursor(context, x, top, bottom) {
  context.strokeStyle = colours.get("ink");
  context.lineWidth = 1;
  context.beginPath();
  context.moveTo(x, top);
  context.lineTo(x, bottom);
  context.stroke();
}

/**
 * A panel with curves. A curve has a `name`, a `colour`, its `points()`, its value `at` an instant,
 * and `number`: what is selected when it is. Limits are dashed lines. `lanes` share the height of the panel;
 * stretches are named above it, or where there are several lanes each in its own.
 */
class Chart {
  constructor(parent, player, selection, { title, note, curves, limits = [], lanes = [], instants = "", isTight = false }) {
    Object.assign(this, { player, selection, curves, limits, lanes, instants, isTight });
    this.reading = element("span", { class: "reading" });
    this.plot = element("div", { class: "plot" });
    parent.append(element("figure", { class: "chart" },
      element("figcaption", {}, element("h3", {}, title), note && element("p", {}, note), this.reading),
      this.plot, curves.length > 1 && curves.length <= FEW_CURVES ? legendOf(curves) : null));
    this.range = this.measure();
    [this.base, this.top] = layered(this.plot, CHART_HEIGHT, (context, size) => this.drawBase(context, size),
      (context, size) => this.drawTop(context, size));
    seekOn(this.top.canvas, player);
    player.onChange(() => this.show());
    selection.onChange(() => { this.base.paint(); this.show(); });
    theme.listeners.push(() => { this.base.paint(); this.top.paint(); });
    this.show();
  }

  /** The values that the panel shows: from 0 on, unless it is tight around the curves. */
  measure() {
    let [low, high] = this.isTight ? [Infinity, -Infinity] : [0, 0];
    const widen = value => {
      if (Number.isFinite(value)) [low, high] = [Math.min(low, value), Math.max(high, value)];
    };
    this.limits.forEach(limit => widen(limit.value));
    this.curves.forEach(curve => {
      for (const [, value] of curve.points()) widen(value);
    });
    if (low > high) [low, high] = [0, 0];
    const room = high > low ? 0.06 * (high - low) : 1;
    return [low < 0 || this.isTight ? low - room : low, high + room];
  }

  scale([width, height]) {
    const { top, bottom } = CHART_MARGIN, [low, high] = this.range;
    const foot = height - bottom;
    const y = value => foot - (value - low) / (high - low) * (foot - top);
    return { ...timeScale(this.player, width), y, foot, head: top, right: width - CHART_MARGIN.right };
  }

  drawBase(context, size) {
    const scale = this.scale(size);
    this.drawGrid(context, scale);
    const chosen = this.selection.shown;
    const isFaint = curve => chosen !== null && curve.number !== undefined && curve.number !== chosen;
    const isMany = this.curves.length > DISTINCT_CURVES;
    for (const curve of [...this.curves].sort((one, other) => isFaint(other) - isFaint(one))) {
      const isChosen = chosen !== null && curve.number === chosen;
      context.strokeStyle = curve.colour();
      context.globalAlpha = isFaint(curve) ? 0.18 : isMany && !isChosen ? 0.5 : 1;
      context.lineWidth = isChosen ? 2.2 : isMany ? 0.9 : 1.4;
      trace(context, curve.points(), scale.x, scale.y);
    }
    context.globalAlpha = 1;
    this.drawLimits(context, scale);
  }

  drawGrid(context, { x, y, head, foot, right }) {
    context.font = `11px ${colours.get("font")}`;
    const height = (foot - head) / this.lanes.length;
    this.lanes.forEach((bands, lane) => bands.forEach((band, index) => {
      const top = head + lane * height, width = x(band.to) - x(band.from);
      context.fillStyle = colours.get("band");
      if ((lane + index) % 2 === 0) context.fillRect(x(band.from), top, width, height);
      context.fillStyle = colours.get("task");
      context.textAlign = "center";
      if (context.measureText(band.name).width < width) {
        context.fillText(band.name, x(band.from) + width / 2, this.lanes.length === 1 ? head - 6 : top + 11);
      }
    }));
    context.strokeStyle = colours.get("grid");
    context.fillStyle = colours.get("quiet");
    context.lineWidth = 1;
    context.textAlign = "right";
    context.textBaseline = "middle";
    for (const value of ticks(...this.range, 5)) {
      const height = Math.round(y(value)) + 0.5;
      context.beginPath();
      context.moveTo(x(0), height);
      context.lineTo(right, height);
      context.stroke();
      context.fillText(written(value), x(0) - 6, height);
    }
    context.textAlign = "center";
    context.textBaseline = "alphabetic";
    for (const at of ticks(0, this.player.end, (right - x(0)) / 60)) {
      context.fillText(written(at), x(at), foot + 15);
    }
    context.textAlign = "left";
    context.fillText(this.instants, 4, foot + 15);
  }

  drawLimits(context, { x, y, right }) {
    context.save();
    context.strokeStyle = context.fillStyle = colours.get("limit");
    context.setLineDash([6, 4]);
    context.textAlign = "right";
    let end = right - 2;
    for (const { value, name } of this.limits) {
      context.beginPath();
      context.moveTo(x(0), y(value));
      context.lineTo(right, y(value));
      context.stroke();
      // Side by side, since limits may lie close together.
      context.save();
      context.setLineDash([]);
      context.strokeStyle = colours.get("paper");
      context.lineWidth = 3;
      context.strokeText(name, end, y(value) - 4);
      context.restore();
      context.fillText(name, end, y(value) - 4);
      end -= context.measureText(name).width + 14;
    }
    context.restore();
  }

  drawTop(context, size) {
    const scale = this.scale(size), x = scale.x(this.player.at);
    drawCursor(context, x, scale.head, scale.foot);
    const chosen = this.selection.shown;
    const shown = this.curves.filter(curve => this.curves.length <= FEW_CURVES || curve.number === chosen);
    for (const curve of shown) {
      const value = curve.at(this.player.at);
      if (!Number.isFinite(value)) continue;
      context.fillStyle = curve.colour();
      context.beginPath();
      context.arc(x, scale.y(value), 3.5, 0, 2 * Math.PI);
      context.fill();
    }
  }

  show() {
    this.top.paint();
    const { at } = this.player;
    const chosen = this.curves.find(curve => curve.number !== undefined && curve.number === this.selection.shown);
    if (chosen || this.curves.length <= FEW_CURVES) {
      const curves = chosen ? [chosen] : this.curves;
      this.reading.textContent = curves.map(curve => `${curve.name} ${written(curve.at(at))}`).join(" · ");
    } else {
      const values = this.curves.map(curve => curve.at(at)).filter(Number.isFinite);
      this.reading.textContent = values.length
        ? `from ${written(Math.min(...values))} to ${written(Math.max(...values))}` : "";
    }
  }
}
