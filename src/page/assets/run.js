// ---- Run: a trajectory of an automaton or a composition ------------------------------------------

/** Points on a curve between two samples. */
const POINTS_BETWEEN_SAMPLES = 24;

/** A trajectory as the page's data hold it. */
class Run {
  constructor(data) {
    Object.assign(this, data);
  }

  /** The phase after a number of jumps. */
  phase(passed) {
    return this.phases[Math.min(passed, this.phases.length - 1)];
  }

  /** The value of a variable at an instant of a phase, and its rate. */
  state(phase, variable, at) {
    const { t, values, rates } = phase;
    let before = 0;
    while (before + 1 < t.length - 1 && t[before + 1] <= at) before++;
    const from = values[before][variable];
    if (before + 1 >= t.length || t[before + 1] <= t[before]) return { value: from, rate: rates[before][variable] };
    const width = t[before + 1] - t[before], s = Math.min(1, Math.max(0, (at - t[before]) / width));
    const to = values[before + 1][variable], rest = 1 - s;
    const start = rates[before][variable] * width, end = rates[before + 1][variable] * width;
    return {
      value: from * (1 + 2 * s) * rest * rest + to * s * s * (3 - 2 * s) + start * s * rest * rest - end * s * s * rest,
      rate: (6 * s * rest * (to - from) + start * rest * (1 - 3 * s) + end * s * (3 * s - 2)) / width,
    };
  }

  /** The curve of a variable, interrupted where a jump changes it. */
  *points(variable) {
    let last = null;
    for (const phase of this.phases) {
      const { t, values } = phase;
      if (last !== null && last !== values[0][variable]) yield [t[0], NaN];
      for (let index = 0; index < t.length; index++) {
        yield [t[index], values[index][variable]];
        const width = t[index + 1] - t[index];
        if (!(width > 0)) continue;
        for (let point = 1; point < POINTS_BETWEEN_SAMPLES; point++) {
          const at = t[index] + width * point / POINTS_BETWEEN_SAMPLES;
          yield [at, this.state(phase, variable, at).value];
        }
      }
      last = values.at(-1)[variable];
    }
  }

  /** The stretches in which a component is in one location. */
  spans(component) {
    const spans = [];
    for (const { locations, t } of this.phases) {
      const [value, last] = [locations[component], spans.at(-1)];
      if (last?.value === value) last.to = t.at(-1);
      else spans.push({ from: t[0], to: t.at(-1), value });
    }
    return spans;
  }
}

/** The colour of a location on a strip. */
function placeColour(number) {
  return `color-mix(in srgb, ${colours.curve(number)} 45%, ${colours.get("paper")})`;
}

const DRAWING_STYLE = `
  svg { display: block; max-width: 100%; height: auto; margin: auto; }
  text { fill: var(--ink) !important; }
  .paper { fill: transparent !important; }
  .stripe { fill: var(--band) !important; }
  .location { fill: var(--band) !important; stroke: var(--quiet) !important; }
  .arrow { stroke: var(--quiet) !important; }
  .column { stroke: var(--grid) !important; }
  .head, .dot { fill: var(--quiet) !important; }
  .location.lit { fill: var(--lit) !important; stroke: var(--ink) !important; stroke-width: 3px !important; }`;

/** The drawing of a component's automaton with the active location lit; buttons choose the component. */
class Drawings {
  constructor(parent, run, player, selection) {
    Object.assign(this, { run, player, selection });
    this.tabs = run.components.map(({ name }, number) => element("button", {
      type: "button", onclick: () => selection.choose(number),
    }, name));
    this.frame = element("div", { class: "drawing" });
    this.shadow = this.frame.attachShadow({ mode: "open" });
    if (run.components.length > 1) parent.append(element("div", { class: "tabs" }, ...this.tabs));
    parent.append(this.frame);
    player.onChange(() => this.show());
    selection.onChange(() => this.show());
    theme.listeners.push(() => this.show());
    this.show();
  }

  show() {
    const { run, player, selection } = this, component = selection.shown ?? 0;
    const { locations, drawing } = run.components[component];
    if (component !== this.component) {
      this.component = component;
      const svg = run.drawings[drawing] ?? "";
      this.shadow.innerHTML = `<style>${DRAWING_STYLE}</style>${svg}`;
      this.frame.hidden = !svg;
      this.tabs.forEach((tab, number) => tab.setAttribute("aria-pressed", number === component));
      this.boxes = [...this.shadow.querySelectorAll("[data-location]")];
    }
    const active = run.phase(player.passed).locations[component];
    for (const box of this.boxes) box.classList.toggle("lit", box.dataset.location === locations[active]);
    this.frame.style.setProperty("--lit", placeColour(active));
  }
}

/** Locations and variables at the current instant. */
class RunFacts {
  constructor(parent, run, player) {
    Object.assign(this, { parent, run, player });
    player.onChange(() => this.show());
    this.show();
  }

  show() {
    const { run, player } = this, phase = run.phase(player.passed);
    const row = (...cells) => element("tr", {}, ...cells.map((cell, place) =>
      element(place ? "td" : "th", place ? {} : { scope: "row" }, cell)));
    const places = run.components.map(({ name, locations }, component) =>
      row(run.components.length > 1 ? name : "location", locations[phase.locations[component]]));
    const states = run.variables.map((name, variable) => {
      const { value, rate } = run.state(phase, variable, player.at);
      return row(name, written(value), written(rate));
    });
    this.parent.replaceChildren(
      element("h2", {}, "State"),
      element("table", { class: "facts" }, ...places),
      states.length ? element("table", { class: "facts" }, row("", "value", "rate / s"), ...states) : "");
  }
}

/** Puts the page of a trajectory together. */
function showRun(data) {
  const run = new Run(data), selection = new Selection();
  const player = new Player({ end: run.end, isWhole: false, events: run.events });
  const clock = (at, passed) => passed === undefined ? `t = ${written(at)} s` : `t = ${written(at)} s · j = ${passed}`;
  const part = id => document.getElementById(id);
  new Drawings(part("stage"), run, player, selection);
  new RunFacts(part("facts"), run, player);
  new Transport(part("transport"), player, { clock, unit: speed => `× ${speed}` });
  new Story(part("story"), player, { clock });
  ["marks", "layers"].forEach(name => part(name).remove());
  document.body.classList.add("run");
  const charts = part("charts");
  new Strips(charts, player, selection, {
    title: "Locations over time",
    rows: run.components.map(({ name, locations }, number) => ({
      name: run.components.length > 1 ? name : "location", number,
      spans: run.spans(number).map(({ from, to, value }) => ({
        from, to, name: locations[value], label: locations[value], colour: () => placeColour(value),
      })),
    })),
  });
  run.variables.forEach((name, variable) => new Chart(charts, player, new Selection(), {
    title: name, instants: "t / s", isTight: true,
    curves: [{
      name, colour: () => colours.curve(variable), points: () => run.points(variable),
      at: at => run.state(run.phase(player.passed), variable, at).value,
    }],
  }));
  return { run, player, selection };
}
