// ---- Strips: where each component is, over the run -----------------------------------------------

/**
 * Rows of coloured stretches: a row has a `name`, a `number` to select and its `spans`
 * `{from, to, colour, name}`. The colours are explained by `legend`, a list of `{name, colour}`.
 */
class Strips {
  constructor(parent, player, selection, { title, note, rows, legend = [] }) {
    Object.assign(this, { player, selection, rows });
    this.row = Math.min(20, Math.max(7, 260 / Math.max(rows.length, 1)));
    this.reading = element("span", { class: "reading" });
    this.plot = element("div", { class: "plot" });
    parent.append(element("figure", { class: "chart" },
      element("figcaption", {}, element("h3", {}, title), note && element("p", {}, note), this.reading),
      this.plot, legend.length ? legendOf(legend) : null));
    const height = this.row * rows.length + 4;
    [this.base, this.top] = layered(this.plot, height, (context, size) => this.drawBase(context, size),
      (context, size) => this.drawTop(context, size));
    seekOn(this.top.canvas, player);
    this.top.canvas.addEventListener("pointermove", event => selection.point(this.numberAt(event)));
    this.top.canvas.addEventListener("pointerleave", () => selection.point(null));
    player.onChange(() => this.show());
    selection.onChange(() => { this.base.paint(); this.show(); });
    theme.listeners.push(() => { this.base.paint(); this.top.paint(); });
    this.show();
  }

  numberAt(event) {
    return this.rows[Math.floor(placeOf(event)[1] / this.row)]?.number ?? null;
  }

  drawBase(context, [width]) {
    const { x } = timeScale(this.player, width), shown = this.selection.shown;
    context.font = `${Math.min(11, Math.max(9, this.row))}px ${colours.get("font")}`;
    context.textBaseline = "middle";
    this.rows.forEach((row, index) => {
      const top = index * this.row, middle = top + this.row / 2;
      const isNamed = this.row >= 10 || index % 5 === 0;
      context.globalAlpha = shown === null || shown === row.number ? 1 : 0.4;
      context.fillStyle = colours.get("quiet");
      context.textAlign = "right";
      if (isNamed) context.fillText(shortened(context, row.name, CHART_MARGIN.left - 8), CHART_MARGIN.left - 6, middle);
      context.textAlign = "center";
      for (const span of row.spans) {
        const left = x(span.from), room = Math.max(0.8, x(span.to) - left);
        context.fillStyle = span.colour();
        context.fillRect(left, top + 0.5, room, this.row - 1);
        if (span.label && context.measureText(span.label).width + 8 < room) {
          context.fillStyle = colours.get("ink");
          context.fillText(span.label, left + room / 2, middle);
        }
      }
    });
    context.globalAlpha = 1;
  }

  drawTop(context, [width, height]) {
    drawCursor(context, timeScale(this.player, width).x(this.player.at), 0, height);
  }

  /** The stretch of a row at the current instant. */
  current(row) {
    const { at } = this.player;
    return row.spans.findLast(span => span.from <= at) ?? row.spans[0];
  }

  show() {
    this.top.paint();
    const row = this.rows.find(row => row.number === this.selection.shown);
    this.reading.textContent = row ? `${row.name}: ${this.current(row)?.name ?? ""}` : "";
  }
}

/** A text that fits into a width. */
function shortened(context, text, width) {
  if (context.measureText(text).width <= width) return text;
  let length = text.length;
  while (length > 1 && context.measureText(`${text.slice(0, length)}…`).width > width) length--;
  return `${text.slice(0, length)}…`;
}
