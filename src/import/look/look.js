const data = JSON.parse(document.getElementById("data").textContent);
const at = id => document.getElementById(id);
const svg = at("plan");
const chosen = { access: [...data.chosen.access], near: data.chosen.near, task: [...data.chosen.task] };

// ---- The plan -----------------------------------------------------------------------------------

const element = (name, attributes, parent) => {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return parent.appendChild(made);
};
const path = rings => rings.map(ring => `M${ring.map(point => point.join(" ")).join("L")}Z`).join("");
const all = [data.boundary, ...data.holes];
const low = [0, 1].map(axis => Math.min(...data.boundary.map(point => point[axis])));
const high = [0, 1].map(axis => Math.max(...data.boundary.map(point => point[axis])));
const extent = Math.max(high[0] - low[0], high[1] - low[1]);

at("upright").setAttribute("transform", "scale(1 -1)");
at("floor").setAttribute("d", path(all));
if (data.picture) {
  const { href, width, height, placement } = data.picture;
  element("image", { href, width, height, transform: `matrix(${placement.join(" ")})`,
    style: "image-rendering: pixelated" }, at("original"));
}
for (const line of data.lines)
  element("path", { class: "original", d: `M${line.map(point => point.join(" ")).join("L")}` }, at("original"));
for (const { rings, reached } of data.room)
  element("path", { class: reached ? "reached" : "cut", "fill-rule": "evenodd", d: path(rings) }, at("room"));
for (const { at: [cx, cy], width } of data.gaps)
  element("circle", { class: "narrow", cx, cy, r: Math.max(width, extent / 150) }, at("narrow"));
for (const [name, [cx, cy]] of data.named) {
  const dot = element("circle", { class: "named", cx, cy, r: extent / 250 }, at("named"));
  element("title", {}, dot).textContent = name;
}

// ---- The view: the wheel zooms, dragging moves --------------------------------------------------

const view = { x: low[0] - 0.04 * extent, y: -high[1] - 0.04 * extent,
  width: high[0] - low[0] + 0.08 * extent, height: high[1] - low[1] + 0.08 * extent };
const show = () => svg.setAttribute("viewBox", `${view.x} ${view.y} ${view.width} ${view.height}`);
const place = event => {
  const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
  return [point.x, -point.y];
};
svg.addEventListener("wheel", event => {
  event.preventDefault();
  const [x, y] = place(event), factor = Math.exp(0.0015 * event.deltaY);
  Object.assign(view, { x: x + (view.x - x) * factor, y: -y + (view.y + y) * factor,
    width: view.width * factor, height: view.height * factor });
  show();
}, { passive: false });
let drag = null, isDragged = false;
svg.addEventListener("pointerdown", event => {
  drag = { from: place(event), x: event.clientX, y: event.clientY };
  isDragged = false;
});
svg.addEventListener("pointermove", event => {
  const [x, y] = place(event);
  at("where").textContent = `(${digits(x)}, ${digits(y)})`;
  if (!drag) return;
  isDragged ||= Math.hypot(event.clientX - drag.x, event.clientY - drag.y) > 4;
  if (!isDragged) return;
  view.x -= x - drag.from[0];
  view.y += y - drag.from[1];
  show();
});
addEventListener("pointerup", () => { drag = null; });

// ---- Places -------------------------------------------------------------------------------------

const decimals = Math.max(0, 3 - Math.floor(Math.log10(extent)));
const digits = value => String(Number(value.toFixed(decimals)));
const isInside = ([x, y]) => all.reduce((inside, ring) => ring.reduce((inside, [bx, by], index) => {
  const [ax, ay] = ring[(index + ring.length - 1) % ring.length];
  return (ay > y) !== (by > y) && x < ax + (y - ay) / (by - ay) * (bx - ax) ? !inside : inside;
}, inside), false);

svg.addEventListener("click", event => {
  if (isDragged) return;
  const mark = event.target.closest("[data-set]");
  if (mark) {
    const [kind, index] = mark.dataset.set.split(" ");
    if (kind === "near") chosen.near = null; else chosen[kind].splice(Number(index), 1);
    return draw();
  }
  const spot = place(event).map(value => Number(digits(value)));
  if (!isInside(spot)) {
    at("where").textContent = `(${spot.join(", ")}) is a wall or outside`;
    return;
  }
  const mode = document.querySelector("[name=mode]:checked").value;
  if (mode === "near") chosen.near = spot; else chosen[mode].push(spot);
  draw();
});

const draw = () => {
  const places = at("places");
  places.replaceChildren();
  const mark = (kind, [cx, cy], set, r, what) => {
    const dot = element("circle", { class: `${kind} ${set ? "mark" : ""}`, cx, cy, r }, places);
    if (set) dot.dataset.set = set;
    element("title", {}, dot).textContent = what;
  };
  // What the program chose is shown until something else is set.
  const size = extent / 90;
  if (!chosen.near) for (const robot of data.robots) mark("robot", robot, null, Math.max(data.clearance, extent / 200), "a robot");
  const access = chosen.access.length || chosen.near ? chosen.access : data.access;
  access.forEach((spot, index) => mark("access", spot, chosen.access.length ? `access ${index}` : null, size, "an access point"));
  if (chosen.near) {
    mark("robot", chosen.near, "near", size, "the robots start here");
    if (!chosen.access.length) mark("access", chosen.near, null, size / 2, "and the access point stands here");
  }
  (chosen.task.length ? chosen.task : data.tasks)
    .forEach((spot, index) => mark("task", spot, chosen.task.length ? `task ${index}` : null, size, `task ${index}`));
  at("command").textContent = [data.command,
    ...chosen.access.map(spot => `--access-point ${spot}`),
    `--robots ${at("robots").value}`,
    ...(chosen.near ? [`--near ${chosen.near}`] : []),
    ...chosen.task.map(spot => `--task ${spot}`)].join(" ");
};

// ---- What stands beside the plan ----------------------------------------------------------------

const color = name => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`);
for (const swatch of document.querySelectorAll(".swatch")) swatch.style.background = color(swatch.dataset.of);
for (const box of document.querySelectorAll("[data-layer]"))
  box.addEventListener("change", () => { at(box.dataset.layer).style.display = box.checked ? "" : "none"; });
const [account, ...notes] = data.notes;
at("account").textContent = account;
for (const note of notes) at("notes").appendChild(document.createElement("li")).textContent = note;
at("gaps").textContent = `passages narrower than 2 × ${data.clearance}: ${data.narrow}`;
at("robots").value = data.count;
at("robots").addEventListener("input", draw);
at("copy").addEventListener("click", () => navigator.clipboard.writeText(at("command").textContent));
show();
draw();
