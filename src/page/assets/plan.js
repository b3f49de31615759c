// ---- Plan: the robots, their links and the tree at an instant ------------------------------------

/** How many control periods a trail reaches back. */
const TRAIL_STEPS = 60;
/** White around the workspace, in pixels. */
const PLAN_MARGIN = 14;
const LAYERS = [
  { key: "links", name: "links", about: "communication links in use, thickness ∝ T·R; they reach through walls", on: true, colour: "link" },
  { key: "tree", name: "tree", about: "edges of the tree network", on: true, colour: "tree" },
  { key: "path", name: "path Σ", about: "the robots that shift when a recruit is called", on: true, colour: "recruit" },
  { key: "geodesic", name: "way to the task", about: "the leader's shortest way to its task", on: true, colour: "task" },
  { key: "trails", name: "trails", about: `where robots were in the last ${TRAIL_STEPS} periods`, on: true, colour: "trail" },
  { key: "labels", name: "labels", about: "numbers of nodes and tasks", on: true },
  { key: "discs", name: "discs", about: "discs of radius ρ, to scale, where marks leave them visible", on: true },
  { key: "free_space", name: "free space", about: "the outline of W_f, ρ from the walls", on: true, colour: "limit" },
  { key: "cells", name: "cells", about: "Voronoi cells of the robots, ρ inwards, eq. (17)", on: false },
  { key: "range", name: "range", about: "of the robot shown: fully reliable links, and any links", on: true },
];

/** Draws a mission at the player's instant. */
class Plan {
  constructor(parent, mission, player, selection) {
    Object.assign(this, { mission, player, selection });
    this.layers = new Map(LAYERS.map(layer => [layer.key, layer.on]));
    this.places = new LabelPlaces();
    this.box = bounds(mission.scenario.workspace.boundary);
    this.frame = element("div", { class: "plan" });
    parent.append(this.frame);
    this.surface = new Surface(this.frame, width => this.heightFor(width), (context, size) => this.draw(context, size));
    const { canvas } = this.surface;
    canvas.id = "plan";
    canvas.addEventListener("pointermove", event => selection.point(this.nodeAt(placeOf(event))));
    canvas.addEventListener("pointerleave", () => selection.point(null));
    canvas.addEventListener("click", event => {
      const node = this.nodeAt(placeOf(event));
      selection.set(node === selection.chosen ? null : node, selection.pointed);
    });
    addEventListener("resize", () => this.surface.fit());
    const repaint = () => this.surface.paint();
    player.onChange(repaint);
    selection.onChange(repaint);
    theme.listeners.push(repaint);
  }

  /** As high as the workspace asks for at this width, and no higher than the window allows. */
  heightFor(width) {
    const [w, h] = this.box.size;
    const room = Math.max(260, window.innerHeight - 205);
    return Math.min(room, (width - 2 * PLAN_MARGIN) * h / w + 2 * PLAN_MARGIN);
  }

  /** The map from the workspace to the surface. */
  view([width, height]) {
    const { low, size: [w, h] } = this.box;
    const scale = Math.min((width - 2 * PLAN_MARGIN) / w, (height - 2 * PLAN_MARGIN) / h);
    const left = (width - w * scale) / 2, foot = (height + h * scale) / 2;
    return { scale, spot: ([x, y]) => [left + (x - low[0]) * scale, foot - (y - low[1]) * scale] };
  }

  /** The node under a place of the surface, or null. */
  nodeAt([x, y]) {
    let best = null, least = 14;
    this.spots?.forEach(([px, py], node) => {
      const distance = Math.hypot(px - x, py - y);
      if (distance < least) [best, least] = [node, distance];
    });
    return best;
  }

  draw(context, size) {
    const { mission, player } = this;
    const view = this.view(size), step = Math.floor(player.at);
    const nodes = mission.places(player.at);
    const spots = nodes.map(view.spot);
    const crowd = nodes.length > 30 ? 4.6 : 6.2;
    const disc = mission.clearance * view.scale;
    const radius = disc > 0.9 * crowd ? Math.max(4, 0.6 * disc) : crowd;
    Object.assign(this, { spots, radius });
    const scene = { context, view, step, nodes, spots, radius, disc };
    const has = key => this.layers.get(key);
    this.drawFloor(scene);
    if (has("free_space")) this.drawFreeSpace(scene);
    if (!nodes.length || !mission.count) return;
    if (has("cells")) this.drawCells(scene);
    if (has("trails")) this.drawTrails(scene);
    if (has("path")) this.drawPath(scene);
    if (has("links")) this.drawLinks(scene);
    if (has("tree")) this.drawTree(scene);
    if (has("geodesic")) this.drawGeodesic(scene);
    if (has("range")) this.drawRange(scene);
    this.drawTarget(scene);
    this.drawTasks(scene);
    this.drawPosts(scene);
    this.drawNodes(scene, has("discs"));
    if (has("labels")) this.places.draw(context, this.labels(scene), this.floor, this.edges(scene), radius);
  }

  outline(loops, { spot }) {
    const path = new Path2D();
    for (const loop of loops) {
      loop.forEach((corner, index) => path[index ? "lineTo" : "moveTo"](...spot(corner)));
      path.closePath();
    }
    return path;
  }

  drawFloor({ context, view }) {
    const { boundary, holes } = this.mission.scenario.workspace;
    const { low, size } = this.box, around = 8;
    const [left, foot] = view.spot(low);
    const [w, h] = size.map(length => length * view.scale + 2 * around);
    context.fillStyle = colours.get("wall");
    context.beginPath();
    context.roundRect(left - around, foot + around - h, w, h, 5);
    context.fill();
    this.floor = this.outline([boundary, ...(holes ?? [])], view);
    context.fillStyle = colours.get("floor");
    context.fill(this.floor, "evenodd");
  }

  drawFreeSpace({ context, view }) {
    context.save();
    context.strokeStyle = colours.get("limit");
    context.globalAlpha = 0.55;
    context.lineWidth = 0.8;
    context.setLineDash([4, 3]);
    context.stroke(this.outline(this.mission.free_space, view));
    context.restore();
  }

  /** The sides of each robot's Voronoi cell, moved inwards by ρ, eq. (17). */
  drawCells({ context, view, nodes }) {
    const { robots, clearance } = this.mission, { low, size } = this.box;
    const all = [low, [low[0] + size[0], low[1]], [low[0] + size[0], low[1] + size[1]], [low[0], low[1] + size[1]]];
    context.save();
    context.clip(this.floor, "evenodd");
    context.strokeStyle = colours.get("quiet");
    context.fillStyle = colours.get("quiet");
    context.lineWidth = 0.8;
    for (let robot = 0; robot < robots; robot++) {
      let cell = all;
      for (let other = 0; other < robots && cell.length; other++) {
        if (other !== robot) cell = cutAtBisector(cell, nodes[robot], nodes[other], clearance);
      }
      if (cell.length < 3) continue;
      const path = this.outline([cell], view);
      context.globalAlpha = 0.07;
      context.fill(path);
      context.globalAlpha = 0.7;
      context.stroke(path);
    }
    context.restore();
  }

  drawTrails({ context, view }) {
    const { mission, player } = this;
    context.save();
    context.strokeStyle = colours.get("trail");
    context.lineWidth = 1.6;
    context.lineCap = context.lineJoin = "round";
    context.setLineDash([1, 4]);
    for (const trail of mission.trails(player.at, TRAIL_STEPS)) {
      context.beginPath();
      trail.forEach((point, index) => context[index ? "lineTo" : "moveTo"](...view.spot(point)));
      context.stroke();
    }
    context.restore();
  }

  drawPath({ context, step, spots, radius }) {
    const path = this.mission.value("path", step).map(node => spots[node]).filter(Boolean);
    if (path.length < 2) return;
    context.save();
    context.strokeStyle = colours.get("recruit");
    context.globalAlpha = 0.22;
    context.lineWidth = 3 * radius;
    context.lineCap = context.lineJoin = "round";
    strokeThrough(context, path);
    context.restore();
  }

  drawLinks({ context, step, spots }) {
    const { faint, full } = this.mission.link;
    context.save();
    context.lineCap = "round";
    const shown = this.selection.shown;
    for (const { from, to, share, reliability } of this.mission.linksAt(step)) {
      if (!spots[from] || !spots[to]) continue;
      context.globalAlpha = shown === null || shown === from || shown === to ? 1 : 0.35;
      context.strokeStyle = colours.get("link");
      context.lineWidth = faint + full * Math.min(1, Math.max(0, share * reliability));
      strokeThrough(context, [spots[from], spots[to]]);
    }
    context.restore();
  }

  drawTree({ context, step, spots }) {
    const { faint, full, tree } = this.mission.link;
    const traffic = new Map(this.mission.linksAt(step).map(link => [`${link.from} ${link.to}`, link.share * link.reliability]));
    context.save();
    context.lineCap = "round";
    context.strokeStyle = colours.get("tree");
    for (const [child, parent] of this.mission.value("tree", step)) {
      if (!spots[child] || !spots[parent]) continue;
      const carried = Math.min(1, traffic.get(`${child} ${parent}`) ?? 0);
      context.lineWidth = Math.max(1.2, tree * (faint + full * carried));
      strokeThrough(context, [spots[child], spots[parent]]);
    }
    context.restore();
  }

  drawGeodesic({ context, view, step, spots }) {
    context.save();
    context.strokeStyle = colours.get("task");
    context.lineWidth = 1.4;
    context.setLineDash([7, 4]);
    for (const [leader, way] of this.mission.value("geodesic", step)) {
      if (way.length && spots[leader]) strokeThrough(context, [spots[leader], ...way.map(view.spot)]);
    }
    context.restore();
  }

  /** The circles in which a node's links are fully reliable, and in which there are any. */
  drawRange({ context, view, spots }) {
    const node = this.selection.shown;
    if (node === null || !spots[node]) return;
    const { full_range, max_range } = this.mission.scenario.link;
    context.save();
    context.clip(this.floor, "evenodd");
    context.strokeStyle = colours.get("link");
    for (const [range, dash] of [[full_range, []], [max_range, [3, 4]]]) {
      context.setLineDash(dash);
      context.beginPath();
      context.arc(...spots[node], range * view.scale, 0, 2 * Math.PI);
      context.stroke();
    }
    context.restore();
  }

  /** Joins the robot that is shown with the place where it goes. */
  drawTarget({ context, view, step, spots, radius }) {
    const robot = this.selection.shown;
    const target = robot === null || robot >= this.mission.robots ? null : this.mission.targetOf(robot, step);
    if (target === null) return;
    const [x, y] = view.spot(target);
    context.save();
    context.strokeStyle = colours.get("task");
    context.lineWidth = 1.2;
    context.setLineDash([2, 3]);
    strokeThrough(context, [spots[robot], [x, y]]);
    context.setLineDash([]);
    strokeThrough(context, [[x - radius, y], [x + radius, y]]);
    strokeThrough(context, [[x, y - radius], [x, y + radius]]);
    context.restore();
  }

  drawTasks({ context, view, step, radius }) {
    const [pursued, serviced, unannounced, over] = this.mission.tasks;
    this.mission.scenario.task.forEach((task, number) => {
      const [x, y] = view.spot(task.position), arm = 1.35 * radius;
      const state = this.mission.value("task_state", step)[number];
      context.save();
      context.strokeStyle = context.fillStyle = colours.get("task");
      context.lineWidth = 0.27 * arm;
      context.globalAlpha = state === unannounced ? 0.4 : state === over ? 0.5 : 1;
      if (state === over) {
        context.beginPath();
        context.arc(x, y, 1.2 * arm, 0, 2 * Math.PI);
        context.lineWidth = 0.16 * arm;
        context.stroke();
        context.restore();
        return;
      }
      strokeThrough(context, [[x - arm, y - arm], [x + arm, y + arm]]);
      strokeThrough(context, [[x - arm, y + arm], [x + arm, y - arm]]);
      context.beginPath();
      context.arc(x, y, 1.5 * arm, 0, 2 * Math.PI);
      context.lineWidth = 0.16 * arm;
      if (state === serviced) context.stroke();
      context.globalAlpha = 0.14;
      if (state === serviced || state === pursued) context.fill();
      context.restore();
    });
  }

  /** Joins a robot that is on its way to its post with that place. */
  drawPosts({ context, view, step, spots, radius }) {
    context.save();
    context.strokeStyle = colours.get("quiet");
    context.fillStyle = colours.get("floor");
    context.lineWidth = 1.2;
    for (const { holder, reference } of this.mission.value("post", step)) {
      const place = view.spot(reference), robot = spots[holder];
      if (!robot || Math.hypot(place[0] - robot[0], place[1] - robot[1]) < radius) continue;
      context.setLineDash([1, 3]);
      strokeThrough(context, [robot, place]);
      context.setLineDash([]);
      context.beginPath();
      context.arc(...place, 3.2, 0, 2 * Math.PI);
      context.fill();
      context.stroke();
    }
    context.restore();
  }

  drawNodes(scene, hasDiscs) {
    const { context, step, spots, radius, disc } = scene, { mission } = this;
    const team = mission.value("active_team", step);
    const order = spots.map((_, node) => node).sort((one, other) => mission.rank(other, step) - mission.rank(one, step));
    context.save();
    context.lineJoin = "round";
    for (const node of order) {
      const [x, y] = spots[node], mark = mission.markOf(node, step);
      if (hasDiscs && node < mission.robots && disc > 0.9 * radius) {
        context.beginPath();
        context.arc(x, y, disc, 0, 2 * Math.PI);
        context.fillStyle = context.strokeStyle = colours.get("ink");
        context.globalAlpha = 0.1;
        context.fill();
        context.globalAlpha = 0.5;
        context.lineWidth = 0.8;
        context.stroke();
        context.globalAlpha = 1;
      }
      drawMark(context, mark, [x, y], radius);
      if (mission.isAbsent(node, step)) drawCross(context, [x, y], radius);
      const isShown = node === this.selection.shown;
      if (!team.includes(node) && !isShown) continue;
      context.beginPath();
      context.arc(x, y, radius * (isShown ? 2.5 : 2.1), 0, 2 * Math.PI);
      context.strokeStyle = colours.get(isShown ? "task" : "ink");
      context.lineWidth = isShown ? 2.4 : 1.3;
      context.stroke();
    }
    context.restore();
  }

  /** What is written beside nodes and tasks, the most telling first. */
  labels({ view, step, spots, radius }) {
    const { mission } = this, team = mission.value("active_team", step);
    const order = spots.map((_, node) => node).sort((one, other) => mission.rank(one, step) - mission.rank(other, step));
    // As far away as the ring or the mark reaches.
    const reach = node => radius * (team.includes(node) ? 2.2 : node < mission.robots ? 1.5 : 1.8);
    const nodes = order.map(node => ({
      key: node, spot: spots[node], colour: node < mission.robots ? "ink" : "access-point",
      text: mission.label(node), reach: reach(node),
      mayGo: mission.markOf(node, step).key === "redundant" && node !== this.selection.shown,
    }));
    const tasks = mission.scenario.task.map(({ position }, number) => ({
      key: `task ${number}`, spot: view.spot(position), colour: "task", text: `task ${number}`, reach: radius * 2.1,
    }));
    return [...tasks, ...nodes];
  }

  /** The edges of the tree, which labels avoid. */
  edges({ step, spots }) {
    return this.mission.value("tree", step).map(edge => edge.map(node => spots[node])).filter(ends => ends.every(Boolean));
  }
}
