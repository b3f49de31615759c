// ---- Tables: numbers and values over the steps of a run ------------------------------------------

const DIGITS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
const VALUE_OF_DIGIT = new Uint8Array(128);
[...DIGITS].forEach((digit, value) => { VALUE_OF_DIGIT[digit.charCodeAt(0)] = value; });

/** Reads the Base64 VLQ numbers of a text, one after the other. */
class Reader {
  constructor(text) {
    this.text = text;
    this.place = 0;
    /** Whether the last number was a zero with a minus sign. */
    this.isBlank = false;
  }

  next() {
    let bits = 0, weight = 1, digit;
    do {
      digit = VALUE_OF_DIGIT[this.text.charCodeAt(this.place++)];
      bits += (digit & 31) * weight;
      weight *= 32;
    } while (digit > 31);
    const size = Math.floor(bits / 2);
    this.isBlank = bits === 1;
    return bits % 2 ? -size : size;
  }
}

/** One number over the steps: where it changes, and to what. */
class Series {
  constructor(text, count, scale) {
    const steps = [], values = [], reader = new Reader(text);
    let step = 0, number = 0, blank = false;
    const note = value => { steps.push(step); values.push(value); };
    while (step < count) {
      const difference = reader.next();
      if (reader.isBlank) {
        note(NaN);
        blank = true;
        step += 1;
      } else if (difference === 0) {
        if (step === 0 || blank) note(number / scale);
        blank = false;
        step += reader.next();
      } else {
        number += difference;
        note(number / scale);
        blank = false;
        step += 1;
      }
    }
    this.steps = Int32Array.from(steps);
    this.values = Float64Array.from(values);
    this.count = count;
  }

  /** The number of the change that holds at a step. */
  index(step) {
    let low = 0, high = this.steps.length;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (this.steps[middle] <= step) low = middle; else high = middle;
    }
    return low;
  }

  at(step) {
    return this.values.length ? this.values[this.index(step)] : NaN;
  }

  /** Between steps on a straight line. */
  between(step) {
    const before = Math.floor(step), share = step - before;
    const value = this.at(before);
    return share > 0 ? value + share * (this.at(Math.min(before + 1, this.count - 1)) - value) : value;
  }

  /** The corners of the curve from step `from` to step `to`. */
  *points(from = 0, to = this.count - 1) {
    if (!this.values.length) return;
    yield [from, this.at(from)];
    for (let index = this.index(from) + 1; index < this.steps.length && this.steps[index] <= to; index++) {
      const step = this.steps[index];
      if (step - 1 > this.steps[index - 1] && step - 1 > from) yield [step - 1, this.values[index - 1]];
      yield [step, this.values[index]];
    }
    if (this.steps[this.index(to)] < to) yield [to, this.at(to)];
  }
}

/** Numbers by column. */
class Table {
  constructor({ decimals, columns }, count) {
    this.columns = columns.map(text => new Series(text, count, 10 ** decimals));
  }

  at(column, step) {
    return this.columns[column].at(step);
  }

  between(column, step) {
    return this.columns[column].between(step);
  }
}

/** Values of any kind by column. */
class Choices {
  constructor({ values, table }, count) {
    this.values = values;
    this.table = new Table(table, count);
  }

  at(step, column = 0) {
    return this.values[this.table.at(column, step)];
  }

  /** The stretches of steps with the same value, or with the same part `of` it. */
  spans(column = 0, of = value => value) {
    const { steps, values, count } = this.table.columns[column], spans = [];
    steps.forEach((from, index) => {
      const to = index + 1 < steps.length ? steps[index + 1] : count - 1;
      const value = of(this.values[values[index]]), last = spans.at(-1);
      if (last && last.value === value) last.to = to; else spans.push({ from, to, value });
    });
    return spans;
  }
}
