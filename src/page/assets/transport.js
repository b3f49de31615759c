// ---- Transport: buttons, time line, story, keys --------------------------------------------------

const KEYS = [
  ["Space", "play or pause"],
  ["← →", "a step back or on"],
  ["Shift ← →", "ten steps"],
  ["↑ ↓", "previous or next event"],
  ["Home End", "to the start or end"],
  ["− +", "slower or faster"],
  ["Esc", "select nothing"],
  ["d", "light or dark"],
];

/** The share of the time line that the mark of an event takes. */
const MARK_SHARE = 0.016;
/** From this many events on, marks on top of each other are left out; the story has them all. */
const MOST_MARKS = 200;

/** The signs of the buttons, in a box of 16 by 16. */
const ICONS = {
  play: "M4 2v12l10-6z",
  pause: "M3 2h4v12H3zM9 2h4v12H9z",
  on: "M2 3v10l7-5zM10 3h3v10h-3z",
  back: "M14 3v10L7 8zM3 3h3v10H3z",
  next: "M1 3v10l6-5zM7 3v10l6-5zM13 3h2v10h-2z",
  previous: "M15 3v10L9 8zM9 3v10L3 8zM1 3h2v10H1z",
};

function icon(sign) {
  const made = element("span", { class: "icon" });
  made.innerHTML = `<svg viewBox="0 0 16 16"><path d="${ICONS[sign]}"/></svg>`;
  return made;
}

/** The buttons, the time line with its events, and the keys. */
class Transport {
  /** `lanes`: stretches of the run `{from, to, name}`, those side by side in lanes; `clock` tells the instant in words, `unit` a speed. */
  constructor(parent, player, { lanes = [], clock, unit, isTelling = () => true, glyph }) {
    Object.assign(this, { player, clock, isTelling, hasGlyphs: Boolean(glyph) });
    const button = (sign, title, act) =>
      element("button", { type: "button", title, "aria-label": title, onclick: act }, icon(sign));
    this.toggle = element("button", { type: "button", id: "play", onclick: () => player.toggle() });
    this.now = element("output", { class: "clock" });
    this.speed = element("select", { title: "Speed (− +)", "aria-label": "Speed", onchange: event => {
      player.speed = Number(event.target.value);
      player.announce();
    } }, ...SPEEDS.map(speed =>
      element("option", { value: speed }, unit(written(speed * player.rate, 3)))));
    parent.append(
      element("div", { class: "buttons" },
        button("previous", "Previous event (↑)", () => player.jump(-1, isTelling)),
        button("back", "A step back (←)", () => player.step(-1)),
        this.toggle,
        button("on", "A step on (→)", () => player.step(1)),
        button("next", "Next event (↓)", () => player.jump(1, isTelling)),
        this.now, this.speed, help()),
      this.timeLine(lanes, glyph));
    player.onChange(() => this.show());
    document.addEventListener("keydown", event => this.press(event));
    this.show();
  }

  timeLine(lanes, glyph) {
    const { player } = this;
    const share = at => `${(100 * at / Math.max(player.end, 1e-12)).toFixed(4)}%`;
    this.thumb = element("div", { class: "thumb" });
    this.fill = element("div", { class: "fill" });
    const isUpper = this.rows(), isCovered = this.covered();
    const marks = player.events.map((event, index) => this.isTelling(event) && !isCovered.has(index) && element("button", {
      type: "button", class: isUpper.has(index) ? "event upper" : "event", tabindex: "-1", style: `left: ${share(event.at)}`,
      title: `${this.clock(event.at)}: ${event.text}`, "data-event": index,
      onclick: () => player.seekEvent(index),
      onpointerdown: press => press.stopPropagation(),
    }, glyph ? glyph(event) : null)).filter(Boolean);
    this.line = element("div", {
      id: "scrubber", class: "line", role: "slider", tabindex: "0", "aria-label": "Instant",
      "aria-valuemin": "0", "aria-valuemax": player.end, style: `--lanes: ${Math.max(1, lanes.length)}`,
    },
    ...lanes.flatMap((bands, lane) => bands.map(band => element("div", {
      class: "band", style: `--lane: ${lane}; left: ${share(band.from)}; width: ${share(band.to - band.from)}`,
    }, band.name))),
    element("div", { class: "track" }, this.fill), ...marks, this.thumb);
    this.share = share;
    const seek = event => {
      const box = this.line.getBoundingClientRect();
      player.seek((event.clientX - box.left) / box.width * player.end);
    };
    this.line.addEventListener("pointerdown", event => {
      this.line.setPointerCapture(event.pointerId);
      seek(event);
    });
    this.line.addEventListener("pointermove", event => { if (event.buttons & 1) seek(event); });
    return this.line;
  }

  /** The events whose marks would lie on the mark of the event before. */
  covered() {
    const { events, end } = this.player, covered = new Set();
    let last = -Infinity;
    events.forEach((event, index) => {
      if (!this.isTelling(event)) return;
      if (events.length > MOST_MARKS && event.at - last < 0.1 * MARK_SHARE * end) covered.add(index); else last = event.at;
    });
    return covered;
  }

  /** The events whose marks stand in the upper row, since the lower one is taken. */
  rows() {
    const { events, end } = this.player, upper = new Set();
    let taken = -Infinity;
    events.forEach((event, index) => {
      if (!this.isTelling(event)) return;
      if (this.hasGlyphs && event.at - taken < MARK_SHARE * end) upper.add(index); else taken = event.at;
    });
    return upper;
  }

  show() {
    const { player } = this;
    if (player.isPlaying !== this.isShownPlaying) {
      this.isShownPlaying = player.isPlaying;
      const [sign, name] = player.isPlaying ? ["pause", "Pause"] : ["play", "Play"];
      this.toggle.replaceChildren(icon(sign), name);
      this.toggle.title = `${name} (space)`;
    }
    this.now.textContent = this.clock(player.at, player.passed);
    this.speed.value = player.speed;
    this.thumb.style.left = this.fill.style.width = this.share(player.at);
    this.line.setAttribute("aria-valuenow", player.at);
    this.line.setAttribute("aria-valuetext", this.now.textContent);
  }

  press(event) {
    const { player } = this;
    const isTaken = event.target.matches("select, textarea")
      || event.key === " " && event.target.matches("input, summary");
    if (event.ctrlKey || event.metaKey || event.altKey || isTaken) return;
    const act = {
      " ": () => player.toggle(),
      ArrowLeft: () => player.step(event.shiftKey ? -10 : -1),
      ArrowRight: () => player.step(event.shiftKey ? 10 : 1),
      ArrowUp: () => player.jump(-1, this.isTelling),
      ArrowDown: () => player.jump(1, this.isTelling),
      Home: () => player.seek(0),
      End: () => player.seek(player.end),
      "+": () => player.shiftSpeed(1),
      "=": () => player.shiftSpeed(1),
      "-": () => player.shiftSpeed(-1),
      d: () => theme.turn(),
      "?": () => document.querySelector("details.help").toggleAttribute("open"),
    }[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  }
}

function help() {
  const rows = KEYS.map(([key, meaning]) =>
    element("tr", {}, element("th", {}, key), element("td", {}, meaning)));
  return element("details", { class: "help" },
    element("summary", { title: "Keys (?)" }, "Keys"), element("table", {}, ...rows));
}

/** The events as a list; a click leads to the event. */
class Story {
  constructor(parent, player, { clock, isTelling = () => true, hasDetails = false }) {
    Object.assign(this, { player });
    this.entries = player.events.map((event, index) => element("button", {
      type: "button", class: isTelling(event) ? "told" : "told detail", "data-event": index,
      onclick: () => player.seekEvent(index),
    }, element("span", { class: "when" }, clock(event.at)), ` ${event.text}`));
    this.list = element("div", { class: "list" }, ...this.entries);
    const details = hasDetails && element("label", {},
      element("input", { type: "checkbox", onchange: event =>
        this.list.classList.toggle("detailed", event.target.checked) }), " details");
    parent.append(element("h2", {}, "Events ", details || null), this.list);
    player.onChange(() => this.show());
    this.show();
  }

  show() {
    let current = this.player.passed - 1;
    this.entries.forEach((entry, index) => entry.classList.toggle("past", index <= current));
    while (current >= 0 && !this.entries[current].offsetParent) current--;
    if (current === this.current) return;
    this.entries[this.current]?.removeAttribute("aria-current");
    this.current = current;
    const entry = this.entries[current];
    if (!entry) { this.list.scrollTop = 0; return; }
    entry.setAttribute("aria-current", "true");
    // Entries are whole lines high: from the top of one on, none is cut.
    const begin = this.entries[0].offsetTop, middle = entry.offsetTop - this.list.clientHeight / 2;
    const first = this.entries.find(one => one.offsetParent && one.offsetTop >= middle);
    this.list.scrollTop = first.offsetTop - begin;
  }
}

/** Light or dark: what the system says, until the button is pressed. */
const theme = {
  listeners: [],
  isDark() {
    const chosen = document.documentElement.dataset.theme;
    return chosen ? chosen === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  },
  turn() {
    document.documentElement.dataset.theme = this.isDark() ? "light" : "dark";
    this.changed();
  },
  changed() {
    colours.forget();
    document.getElementById("theme").textContent = this.isDark() ? "☀" : "☾";
    this.listeners.forEach(listener => listener());
  },
  start() {
    document.getElementById("theme").addEventListener("click", () => this.turn());
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.changed());
    addEventListener("beforeprint", () => this.print(true));
    addEventListener("afterprint", () => this.print(false));
    this.changed();
  },
  /** On paper everything is light. */
  print(begins) {
    if (begins) [this.before, document.documentElement.dataset.theme] = [document.documentElement.dataset.theme ?? "", "light"];
    else if (this.before) document.documentElement.dataset.theme = this.before;
    else delete document.documentElement.dataset.theme;
    this.changed();
  },
};
