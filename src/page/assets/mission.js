// ---- Mission: what the data say of robots, links and tasks ---------------------------------------

/** A mission as the page's data hold it. */
class Mission {
  constructor(data) {
    Object.assign(this, data);
    const { count, numbers, values, links } = data.steps;
    this.count = count;
    this.numbers = mapped(numbers, table => new Table(table, count));
    this.values = mapped(values, choices => new Choices(choices, count));
    this.pairs = links.pairs;
    this.share = new Table(links.share, count);
    this.reliability = new Table(links.reliability, count);
    this.robots = this.scenario.robot.length;
    this.nodes = this.robots + this.scenario.access_point.length;
    this.clearance = this.scenario.control.clearance;
    this.period = this.scenario.control.period;
    this.markKeys = new Map(this.marks.map((mark, rank) => [mark.key, { ...mark, rank }]));
  }

  /** The number of the last control period. */
  get last() { return Math.max(0, this.count - 1); }

  /** A field of the trace at a control period. */
  value(name, step) {
    return this.values[name].at(Math.floor(step));
  }

  /** The mission under way, or that of each fleet. */
  missions(step) {
    const one = name => this.value(name, step), names = ["phase", "task", "primary_team", "active_team", "path"];
    const whole = () => Object.fromEntries([["access_point", null], ...names.map(name => [name, one(name)])]);
    return "fleets" in this.values ? one("fleets") : [whole()];
  }

  role(robot, step) { return this.values.role.at(Math.floor(step), robot); }

  markOf(node, step) {
    const key = node < this.robots ? this.values.mark.at(Math.floor(step), node) : "access-point";
    return this.markKeys.get(key);
  }

  /** Whether a node does not run, or is not heard. */
  isAbsent(node, step) { return this.count > 0 && this.value("absent", step).includes(node); }

  /** What is written beside a node: access points are numbered from 0, as in the scenario. */
  label(node) { return node < this.robots ? String(node) : `AP ${node - this.robots}`; }

  /** The same where it does not stand beside it. */
  nodeName(node) { return node < this.robots ? `robot ${node}` : this.label(node); }

  /** What is more telling comes first. */
  rank(node, step) { return this.markOf(node, step).rank; }

  /** Where a robot is; between the lines of a trace robots move on straight segments. */
  position(robot, at) {
    return [0, 1].map(axis => this.numbers.position.between(2 * robot + axis, at));
  }

  /** Where all nodes are, robots first. */
  places(at) {
    if (!this.count) return this.scenario.robot.concat(this.scenario.access_point).map(node => node.position);
    const robots = Array.from({ length: this.robots }, (_, robot) => this.position(robot, at));
    return robots.concat(this.scenario.access_point.map(point => point.position));
  }

  /** Where a robot goes, or null; old traces do not tell. */
  targetOf(robot, step) {
    const { columns } = this.numbers.target;
    if (!columns.length) return null;
    const target = [0, 1].map(axis => columns[2 * robot + axis].at(Math.floor(step)));
    return target.some(Number.isNaN) ? null : target;
  }

  /** A name for a robot at a control period, or null where the trace has none. */
  named(field, robot, step) {
    return this.values[field]?.at(Math.floor(step), robot) ?? null;
  }

  residual(robot, step) { return this.numbers.residual.at(robot, Math.floor(step)); }
  multiplier(robot, step) { return this.numbers.multiplier.at(robot, Math.floor(step)); }

  /** The links in use at a control period. */
  linksAt(step) {
    const whole = Math.floor(step);
    if (this.known?.step === whole) return this.known.links;
    const links = [];
    this.pairs.forEach(([from, to], column) => {
      const share = this.share.at(column, whole);
      if (share !== 0) links.push({ from, to, share, reliability: this.reliability.at(column, whole) });
    });
    this.known = { step: whole, links };
    return links;
  }

  /** Where the robots have been in the last `steps` control periods, as far as they moved. */
  trails(at, steps) {
    const { columns } = this.numbers.position, from = Math.max(0, Math.floor(at) - steps), trails = [];
    for (let robot = 0; robot < this.robots; robot++) {
      const [x, y] = [columns[2 * robot], columns[2 * robot + 1]];
      if (x.index(from) === x.index(at) && y.index(from) === y.index(at)) continue;
      const trail = [];
      for (let step = from; step < at; step++) trail.push([x.at(step), y.at(step)]);
      trails.push([...trail, this.position(robot, at)]);
    }
    return trails;
  }

  /** The stretches in which each task is pursued, in a lane for each team. */
  lanes() {
    const { fleets, task } = this.values;
    const tasks = fleets ? fleets.at(0).map((_, fleet) => fleets.spans(0, all => all[fleet].task)) : [task.spans()];
    return tasks.map(spans => spans.filter(span => span.value !== null)
      .map(span => ({ from: span.from, to: span.to, name: `task ${span.value}` })));
  }
}

function mapped(record, change) {
  return Object.fromEntries(Object.entries(record).map(([name, value]) => [name, change(value)]));
}

/** What is known of the shown node, or of the mission as a whole. */
class Facts {
  constructor(parent, mission, player, selection) {
    Object.assign(this, { parent, mission, player, selection });
    player.onChange(() => this.show());
    selection.onChange(() => this.show());
    this.show();
  }

  show() {
    const { mission, player, selection } = this, step = Math.floor(player.at);
    if (!mission.count) {
      this.parent.replaceChildren(element("h2", {}, "Nothing is recorded"));
      return;
    }
    const node = selection.shown;
    const [title, rows, links] = node === null ? this.ofMission(step)
      : node < mission.robots ? this.ofRobot(node, step) : this.ofAccessPoint(node, step);
    this.parent.replaceChildren(
      element("h2", {}, title),
      element("table", { class: "facts" }, ...rows.filter(Boolean).map(([name, value]) =>
        element("tr", {}, element("th", { scope: "row" }, name), element("td", {}, value)))),
      links ?? "");
  }

  ofMission(step) {
    const { mission } = this, held = mission.value("serviced", step);
    const missions = mission.missions(step).flatMap(({ access_point, phase, task, primary_team, active_team, path }) => [
      access_point === null ? null : ["access point", mission.nodeName(mission.robots + access_point)],
      ["phase", phase],
      ["task pursued", task === null ? "none" : String(task)],
      ["leader", primary_team.length ? `robot ${primary_team.at(-1)}` : "none"],
      ["primary team", chained(primary_team)],
      ["active team", chained(active_team)],
      ["path Σ", chained(path)],
    ]);
    return ["Mission", [
      ...missions,
      ["tasks held", held.length ? held.map(([done, robot]) => `${done} by robot ${robot}`).join(", ") : "none"],
      ["", "Point at a robot for its facts; click to keep it."],
    ]];
  }

  ofRobot(robot, step) {
    const { mission } = this, [x, y] = mission.position(robot, step);
    const tree = mission.value("tree", step);
    const parent = tree.find(([child]) => child === robot)?.[1];
    const children = tree.filter(([, node]) => node === robot).map(([child]) => child);
    const links = mission.linksAt(step);
    const [out, into] = [links.filter(link => link.from === robot), links.filter(link => link.to === robot)];
    const load = out.reduce((sum, link) => sum + link.share, 0);
    return [`Robot ${robot}`, [
      mission.isAbsent(robot, step) && ["state", "stopped, or not received"],
      ["role", mission.role(robot, step)],
      ["location", this.location(robot, step)],
      ["target", this.target(robot, step)],
      ["residual cᵢ", written(mission.residual(robot, step))],
      ["multiplier λᵢ", written(mission.multiplier(robot, step))],
      ["load ΣTᵢⱼ", written(load, 4)],
      this.messages(robot, step),
      ["receives from", this.heard(robot, step)],
      this.knowledge(robot, step),
      ["parent", parent === undefined ? "none" : mission.nodeName(parent)],
      ["children", children.length ? children.join(", ") : "none"],
      ["position", `(${written(x)}, ${written(y)})`],
      ["state", mission.value("active", step).includes(robot) ? "may move" : "stands still"],
      ["rate rᵢ", written(mission.scenario.robot[robot].rate)],
      ...this.further(robot, step),
    ], linkTable(mission, out, into)];
  }

  ofAccessPoint(node, step) {
    const { mission } = this, [x, y] = mission.scenario.access_point[node - mission.robots].position;
    const into = mission.linksAt(step).filter(link => link.to === node);
    const arriving = into.reduce((sum, link) => sum + link.share * link.reliability, 0);
    const children = mission.value("tree", step).filter(([, parent]) => parent === node).map(([child]) => child);
    return [`Access point ${node - mission.robots}`, [
      ["node", String(node)],
      ["position", `(${written(x)}, ${written(y)})`],
      ["children", children.length ? children.join(", ") : "none"],
      ["receives ΣTᵢⱼRᵢⱼ", written(arriving, 4)],
      ["receives from", this.heard(node, step)],
    ], linkTable(mission, [], into)];
  }

  /** Where a robot is in its automata: its duty, and an exchange of duties if it is in one. */
  location(robot, step) {
    const { mission } = this, exchange = mission.named("exchange", robot, step);
    const duty = mission.named("location", robot, step) ?? "not recorded";
    return exchange === null || exchange === "free" ? duty : `${duty}; ${exchange} an exchange of duties`;
  }

  /** The messages of a control period. */
  messages(robot, step) {
    const [sent, heard] = ["sent", "heard"].map(name => this.mission.numbers[name].columns[robot]?.at(step));
    return sent === undefined ? null : ["messages", `${sent} sent, ${heard} received in this period`];
  }

  /** Where the mission stands as far as a robot knows. */
  knowledge(robot, step) {
    const phase = this.mission.named("known_phase", robot, step);
    return phase === null ? null : ["its phase", phase];
  }

  /** Where a robot goes or stays, and why. */
  target(robot, step) {
    const place = this.mission.targetOf(robot, step), reason = this.purpose(robot, step);
    if (place === null) return reason;
    const spot = `(${written(place[0])}, ${written(place[1])})`;
    return reason === "none" ? spot : `${reason}, at ${spot}`;
  }

  purpose(robot, step) {
    const { mission } = this;
    const post = mission.value("post", step).find(post => post.holder === robot);
    const path = mission.value("path", step);
    const led = mission.missions(step).find(({ primary_team }) => primary_team.at(-1) === robot);
    if (led && led.task !== null) return `task ${led.task}`;
    if (post?.task != null) return `post at task ${post.task}`;
    if (post) return post.junction ? "post of a junction" : "post of a node";
    if (path.includes(robot)) return "the next place on path Σ";
    return "none";
  }

  /** The nodes within the range of links. */
  heard(node, step) {
    const { mission } = this, places = mission.places(step), [x, y] = places[node];
    const range = mission.scenario.link.max_range;
    const near = places.flatMap(([px, py], other) =>
      other !== node && Math.hypot(px - x, py - y) < range ? [other] : []);
    return near.length ? near.map(other => mission.label(other)).join(", ") : "none in range";
  }

  /** Fields of the trace with a value for each robot that this page has no words for. */
  further(robot, step) {
    const { mission } = this;
    return Object.keys(mission.values).filter(name => !KNOWN_FIELDS.has(name)).flatMap(name => {
      const value = mission.value(name, step);
      if (!Array.isArray(value) || value.length !== mission.robots) return [];
      const text = typeof value[robot] === "string" ? value[robot] : JSON.stringify(value[robot]);
      return [[name.replaceAll("_", " "), text]];
    });
  }
}

const KNOWN_FIELDS = new Set(["role", "mark", "location", "exchange", "known_phase", "active", "tree", "task", "phase", "active_team", "primary_team",
  "path", "serviced", "post", "task_state", "geodesic", "absent", "fleets"]);


function chained(team) {
  return team.length ? team.join(" → ") : "none";
}

/** The links of a node, the busiest first. */
function linkTable(mission, out, into) {
  const row = (arrow, node, { share, reliability }) => element("tr", {},
    element("th", { scope: "row" }, `${arrow} ${mission.nodeName(node)}`),
    ...[share, reliability, share * reliability].map(value => element("td", {}, written(value, 3))));
  const busy = links => [...links].sort((one, other) => other.share * other.reliability - one.share * one.reliability);
  const rows = [...busy(out).map(link => row("to", link.to, link)), ...busy(into).map(link => row("from", link.from, link))];
  if (!rows.length) return element("p", { class: "quiet" }, "no links in use");
  return element("div", { class: "list links" }, element("table", { class: "facts" },
    element("tr", {}, ...["link", "T", "R", "T·R"].map(name => element("th", { scope: "col" }, name))), ...rows));
}

/** The marks of nodes that stop and restart: a cross, and an arrow upwards. */
const ATTENDANCE = [
  { name: "stopped", about: "node stopped, or not received", strokes: [[[-0.8, -0.8], [0.8, 0.8]], [[-0.8, 0.8], [0.8, -0.8]]] },
  { name: "restarted", about: "node back", strokes: [[[0, 0.9], [0, -0.9]], [[-0.7, -0.2], [0, -0.9], [0.7, -0.2]]] },
];

/** What stands on the time line, and the mark of each. */
function timeMarks(mission) {
  const known = new Map([...mission.moments, ...ATTENDANCE].map(mark => [mark.name, mark]));
  const markOf = event => known.get(event.moment ?? event.event);
  return {
    isTelling: event => Boolean(markOf(event)) || event.event === "violated",
    glyph: event => markOf(event) ? momentGlyph(markOf(event).strokes) : element("span", { class: "alarm" }, "!"),
  };
}

/** What the marks mean. */
function markPanel(parent, mission) {
  const sample = draw => {
    const canvas = element("canvas", { class: "sample" });
    const paint = () => {
      const density = window.devicePixelRatio || 1;
      [canvas.width, canvas.height] = [22 * density, 22 * density];
      const context = canvas.getContext("2d");
      context.setTransform(density, 0, 0, density, 0, 0);
      draw(context, [11, 11], 5.4);
    };
    paint();
    theme.listeners.push(paint);
    return canvas;
  };
  const row = (picture, name) => element("span", {}, picture, name);
  const marks = mission.marks.map(mark => row(sample((context, spot, radius) => drawMark(context, mark, spot, radius)), mark.name));
  const moments = mission.moments.map(moment => row(momentGlyph(moment.strokes), moment.name));
  const attendance = ATTENDANCE.filter(mark => mission.events.some(event => event.event === mark.name))
    .map(mark => row(mark.name === "stopped" ? sample(drawStopped) : momentGlyph(mark.strokes), mark.about));
  parent.append(element("details", { open: true }, element("summary", {}, "Marks"),
    element("div", { class: "boxes" }, ...marks, ...attendance, ...moments)));
}

/** The switches of the layers. */
function layerPanel(parent, plan) {
  const boxes = LAYERS.map(({ key, name, about, on, colour }) => element("label", { title: about }, element("input", {
    type: "checkbox", checked: on, "data-layer": key, onchange: event => {
      plan.layers.set(key, event.target.checked);
      plan.surface.paint();
    },
  }), colour ? element("i", { style: `background: var(--${colour})` }) : "", ` ${name}`));
  parent.append(element("details", { open: true }, element("summary", {}, "Layers"), element("div", { class: "boxes" }, ...boxes),
    element("p", { class: "quiet" }, "Links reach through walls; robots do not.")));
}

/** The strokes of a moment as a small picture. */
function momentGlyph(strokes) {
  const lines = strokes.map(stroke => `<polyline points="${stroke.map(point => point.join()).join(" ")}"/>`).join("");
  const glyph = element("span", { class: "glyph" });
  glyph.innerHTML = `<svg viewBox="-1.4 -1.4 2.8 2.8">${lines}</svg>`;
  return glyph;
}

/** Puts the page of a mission together. */
function showMission(data) {
  const mission = new Mission(data), selection = new Selection();
  const player = new Player({ end: mission.last, isWhole: true, events: mission.events });
  const clock = at => mission.period === 1 ? `k = ${Math.floor(at)}`
    : `k = ${Math.floor(at)} · t = ${written(at * mission.period, 4)} s`;
  const part = id => document.getElementById(id);
  const lanes = mission.count ? mission.lanes() : [];
  const plan = new Plan(part("stage"), mission, player, selection);
  new Facts(part("facts"), mission, player, selection);
  markPanel(part("marks"), mission);
  layerPanel(part("layers"), plan);
  new Transport(part("transport"), player, {
    lanes, clock, unit: speed => `${speed} periods/s`, ...timeMarks(mission),
  });
  new Story(part("story"), player, { clock, isTelling: event => event.telling, hasDetails: true });
  if (mission.count) missionCharts(part("charts"), mission, player, selection, lanes);
  return { mission, player, selection, plan };
}

/** Most robots have no duty most of the time: their colour stays in the background. */
function stripColour(key) {
  return key === "redundant" ? "grid" : key;
}

function missionCharts(parent, mission, player, selection, lanes) {
  const { clearance, control = mission.scenario.control } = mission;
  const common = { lanes, instants: "k" };
  const robots = [...Array(mission.robots).keys()];
  const curves = name => robots.map(robot => {
    const series = mission.numbers[name].columns[robot];
    return { name: `robot ${robot}`, number: robot, colour: () => colours.curve(robot), points: () => series.points(), at: at => series.at(Math.floor(at)) };
  });
  const distance = (column, name, colour) => {
    const series = mission.numbers.distance.columns[column];
    return { name, colour: () => colours.get(colour), points: () => series.points(), at: at => series.at(Math.floor(at)) };
  };
  new Strips(parent, player, selection, {
    title: "Roles over time",
    rows: robots.map(robot => ({
      name: mission.robots > 20 ? String(robot) : `robot ${robot}`, number: robot,
      spans: mission.values.mark.spans(robot).map(span => ({
        from: span.from, to: span.to, name: mission.markKeys.get(span.value).name, colour: () => colours.get(stripColour(span.value)),
      })),
    })),
    legend: mission.marks.slice(1).map(mark => ({ name: mark.name, colour: () => colours.get(stripColour(mark.key)) })),
  });
  new Chart(parent, player, selection, {
    ...common, title: "Smallest distances",
    note: "between two robots, and from a robot to a wall, at the beginning of each control period",
    curves: [distance(0, "robots", "access-point"), distance(1, "walls", "primary-team")],
    limits: [{ value: 2 * clearance, name: `2ρ = ${written(2 * clearance)}` }, { value: clearance, name: `ρ = ${written(clearance)}` }],
  });
  new Chart(parent, player, selection, {
    ...common, title: "Residuals cᵢ",
    note: "what a robot can send beyond what it must, eq. (5), as a share of the radio's rate",
    curves: curves("residual"), limits: [{ value: -control.residual_tolerance, name: "−c_min" }],
  });
  new Chart(parent, player, selection, {
    ...common, title: "Lagrange multipliers λᵢ", note: "the price of rate at each robot, eq. (14)",
    curves: curves("multiplier"),
  });
}
