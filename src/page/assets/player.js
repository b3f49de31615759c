// ---- Player: where the run stands ----------------------------------------------------------------

/** How many seconds a whole run takes at the usual speed. */
const USUAL_SECONDS = 45;
/** Speeds relative to the usual one. */
const SPEEDS = [0.1, 0.2, 0.5, 1, 2, 5, 10];

/**
 * Where the run stands: an instant `at` between 0 and `end`, and how many events are past.
 * Several events may share an instant; then the instant alone does not tell which are past.
 */
class Player {
  /** `isWhole`: the run has a state at whole numbers, and is on its way between them. */
  constructor({ end, isWhole, events }) {
    Object.assign(this, { end, isWhole, events });
    this.at = 0;
    this.passed = this.passedAt(0);
    this.isPlaying = false;
    this.speed = 1;
    this.listeners = [];
    /** Units of `at` per second at the usual speed. */
    this.rate = roundNumber(end / USUAL_SECONDS);
  }

  onChange(listener) {
    this.listeners.push(listener);
  }

  announce() {
    this.listeners.forEach(listener => listener(this));
  }

  /** How many events are past at an instant. */
  passedAt(at) {
    let passed = 0;
    while (passed < this.events.length && this.events[passed].at <= at) passed++;
    return passed;
  }

  seek(at, passed) {
    const whole = this.isWhole && !this.isPlaying ? Math.round(at) : at;
    this.at = Math.min(this.end, Math.max(0, whole));
    this.passed = passed ?? this.passedAt(this.at);
    this.announce();
  }

  /** To the instant just after an event, and stays there. */
  seekEvent(index) {
    this.pause();
    this.seek(this.events[index].at, index + 1);
  }

  /** To the next event ahead (1) or behind (−1) that `isWanted`. */
  jump(direction, isWanted = () => true) {
    const { events } = this;
    if (direction > 0) {
      for (let index = this.passed; index < events.length; index++) {
        if (isWanted(events[index])) return this.seekEvent(index);
      }
      return this.seek(this.end);
    }
    const isBehind = index => events[index].at < this.at || !this.isWhole && index < this.passed - 1;
    for (let index = Math.min(this.passed, events.length) - 1; index >= 0; index--) {
      if (isBehind(index) && isWanted(events[index])) return this.seekEvent(index);
    }
    return this.seek(0, this.isWhole ? undefined : 0);
  }

  /** By a number of control periods, or hundredths of the run. */
  step(count) {
    this.pause();
    this.seek(this.at + count * (this.isWhole ? 1 : this.end / 200));
  }

  toggle() {
    if (this.isPlaying) this.pause(); else this.play();
  }

  play() {
    if (this.isPlaying || this.end <= 0) return;
    if (this.at >= this.end) this.seek(0);
    this.isPlaying = true;
    let last;
    const advance = now => {
      if (!this.isPlaying) return;
      const elapsed = last === undefined ? 0 : Math.min(0.25, (now - last) / 1000);
      last = now;
      this.seek(this.at + elapsed * this.rate * this.speed);
      if (this.at >= this.end) this.pause(); else requestAnimationFrame(advance);
    };
    this.announce();
    requestAnimationFrame(advance);
  }

  pause() {
    if (!this.isPlaying) return;
    this.isPlaying = false;
    this.seek(this.isWhole ? Math.floor(this.at) : this.at);
  }

  /** Faster (1) or slower (−1). */
  shiftSpeed(direction) {
    const index = SPEEDS.indexOf(this.speed) + direction;
    this.speed = SPEEDS[Math.min(SPEEDS.length - 1, Math.max(0, index))];
    this.announce();
  }
}
