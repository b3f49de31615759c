// ---- Canvas: elements, colours, surfaces, axes ---------------------------------------------------

/** An element with attributes and children. */
function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else if (value !== false && value != null) made.setAttribute(key, value === true ? "" : value);
  }
  made.append(...children.filter(child => child != null));
  return made;
}

/** The colours of the style sheet; they change with the theme. */
const colours = {
  known: new Map(),
  get(name) {
    if (!this.known.has(name)) {
      this.known.set(name, getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim());
    }
    return this.known.get(name);
  },
  forget() { this.known.clear(); },
  /** The colour of a curve; past the last they begin again. */
  curve(number) { return this.get(`curve-${number % 12}`); },
};

/** How wide surfaces are on paper, in pixels. */
const PAPER_WIDTH = 700;

/**
 * A drawing surface that is as sharp as the screen. `draw` paints it whenever its size changes, and
 * for paper, of which it is told.
 */
class Surface {
  constructor(parent, height, draw) {
    this.canvas = element("canvas");
    this.context = this.canvas.getContext("2d");
    this.height = height;
    this.draw = draw;
    parent.append(this.canvas);
    new ResizeObserver(() => this.fit(this.isOnPaper)).observe(parent);
    addEventListener("beforeprint", () => this.fit(true));
    addEventListener("afterprint", () => this.fit());
    this.parent = parent;
    this.fit();
  }

  fit(isOnPaper = false) {
    const density = window.devicePixelRatio || 1;
    const width = isOnPaper ? PAPER_WIDTH : Math.max(1, this.parent.clientWidth);
    this.isOnPaper = isOnPaper;
    const height = Math.max(1, typeof this.height === "function" ? this.height(width) : this.height);
    this.size = [width, height];
    this.canvas.style.height = `${height}px`;
    const pixels = [Math.round(width * density), Math.round(height * density)];
    if (this.canvas.width !== pixels[0] || this.canvas.height !== pixels[1]) {
      [this.canvas.width, this.canvas.height] = pixels;
    }
    this.context.setTransform(density, 0, 0, density, 0, 0);
    this.paint();
  }

  paint() {
    this.context.clearRect(0, 0, ...this.size);
    this.draw(this.context, this.size, this.isOnPaper);
  }
}

/** Where the pointer of an event is on its element. */
function placeOf(event) {
  const box = event.currentTarget.getBoundingClientRect();
  return [event.clientX - box.left, event.clientY - box.top];
}

/** The largest of 1, 2 and 5 times a power of ten that is at most `limit`; 1 if there is none. */
function roundNumber(limit) {
  if (!(limit > 0 && Number.isFinite(limit))) return 1;
  const power = 10 ** Math.floor(Math.log10(limit) + 1e-9);
  return power * ([5, 2].find(factor => factor * power <= limit) ?? 1);
}

/** About `count` round numbers from `low` to `high`. */
function ticks(low, high, count) {
  if (!(high > low)) return [];
  const step = roundNumber(2 * (high - low) / count);
  const found = [];
  for (let index = Math.ceil(low / step - 1e-9); index * step <= high + 1e-9 * step; index++) found.push(index * step);
  return found;
}

/** A number for people: at most `digits` digits that count, with a real minus sign. */
function written(value, digits = 5) {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "—" : value > 0 ? "∞" : "−∞";
  const size = Math.abs(value);
  const text = size !== 0 && (size >= 1e7 || size < 1e-5)
    ? size.toExponential(digits - 1).replace(/\.?0+e/, "e")
    : String(Number(size.toPrecision(digits)));
  return value < 0 && Number(text) !== 0 ? `−${text}` : text;
}

/** Draws curves through points so that no more than four points fall on one pixel. */
function trace(context, points, x, y) {
  let column = NaN, low = 0, high = 0, last = 0, lastX = 0, pen = false;
  const flush = () => {
    if (Number.isNaN(column)) return;
    context.lineTo(lastX, low);
    context.lineTo(lastX, high);
    context.lineTo(lastX, last);
  };
  context.beginPath();
  for (const [at, value] of points) {
    if (!Number.isFinite(value)) {
      flush();
      [pen, column] = [false, NaN];
      continue;
    }
    const [px, py] = [x(at), y(value)];
    if (!pen) { context.moveTo(px, py); pen = true; }
    if (Math.round(px) !== column) {
      flush();
      [column, low, high] = [Math.round(px), py, py];
      context.lineTo(px, py);
    }
    [low, high, last, lastX] = [Math.min(low, py), Math.max(high, py), py, px];
  }
  flush();
  context.stroke();
}
