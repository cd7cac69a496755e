import type { Telemetry } from './protocol/lines';

const CAPACITY = 36_000; // two hours at 5 Hz
export const GAP_S = 1; // longer without a line: a gap

export interface Mark {
  t: number;
  text: string;
  answered: boolean | null; // null: not yet
}

/** The session's telemetry in memory of a fixed size: the oldest is forgotten. Seconds. */
export class Series {
  private readonly data = { t: new Float64Array(CAPACITY), height: new Float32Array(CAPACITY), reference: new Float32Array(CAPACITY), thrust: new Float32Array(CAPACITY), truth: new Float32Array(CAPACITY) };
  private readonly state = new Uint8Array(CAPACITY);
  private readonly flags = new Uint16Array(CAPACITY);
  private readonly states: string[] = [];
  private readonly doubt = new Uint8Array(CAPACITY);
  private readonly limit = new Uint8Array(CAPACITY);
  private readonly names: string[] = ['']; // of doubts and limits
  private begin = 0;
  count = 0;
  marks: Mark[] = [];

  add(t: number, line: Telemetry, truth: number): void {
    const at = (this.begin + this.count) % CAPACITY;
    if (this.count === CAPACITY) this.begin = (this.begin + 1) % CAPACITY;
    else this.count++;
    this.data.t[at] = t;
    this.data.height[at] = line.height;
    this.data.reference[at] = line.reference;
    this.data.thrust[at] = line.thrust;
    this.data.truth[at] = truth;
    this.flags[at] = line.flags;
    let state = this.states.indexOf(line.state);
    if (state < 0) state = this.states.push(line.state) - 1;
    this.state[at] = state;
    this.doubt[at] = this.nameOf(line.doubt);
    this.limit[at] = this.nameOf(line.limit);
  }

  private nameOf(name = ''): number {
    const known = this.names.indexOf(name);
    return known >= 0 ? known : this.names.length < 255 ? this.names.push(name) - 1 : 0;
  }

  mark(t: number, text: string): Mark {
    const mark = { t, text, answered: null };
    this.marks.push(mark);
    if (this.marks.length > 2000) this.marks.splice(0, 1000);
    return mark;
  }

  clear(): void {
    this.begin = this.count = 0;
    this.marks = [];
  }

  get end(): number {
    return this.count === 0 ? 0 : this.data.t[(this.begin + this.count - 1) % CAPACITY]!;
  }

  get start(): number {
    return this.count === 0 ? 0 : this.data.t[this.begin]!;
  }

  /** What lies within, at most `most` rows of it, with a row of nulls in each gap. */
  window(from: number, to: number, most = 1500): { columns: (number | null)[][]; states: string[]; doubt: string[]; limit: string[] } {
    const columns: (number | null)[][] = [[], [], [], [], []];
    const states: string[] = [];
    const doubt: string[] = [];
    const limit: string[] = [];
    let low = 0;
    let high = this.count;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.data.t[(this.begin + middle) % CAPACITY]! < from) low = middle + 1;
      else high = middle;
    }
    let end = low;
    for (let step = this.count - low; step > 0; step >>= 1) while (end + step <= this.count && this.data.t[(this.begin + end + step - 1) % CAPACITY]! <= to) end += step;
    const stride = Math.max(1, Math.ceil((end - low) / most));
    let before = NaN;
    const number = (value: number): number | null => (Number.isNaN(value) ? null : value);
    for (let i = low; i < end; i += stride) {
      const at = (this.begin + i) % CAPACITY;
      const t = this.data.t[at]!;
      if (t - before > GAP_S * stride && stride === 1) {
        columns[0]!.push((t + before) / 2);
        for (const column of columns.slice(1)) column.push(null);
        for (const names of [states, doubt, limit]) names.push('');
      }
      before = t;
      columns[0]!.push(t);
      columns[1]!.push(number(this.data.height[at]!));
      columns[2]!.push(this.data.reference[at]! > 0 ? this.data.reference[at]! : null);
      columns[3]!.push(number(this.data.thrust[at]!));
      columns[4]!.push(number(this.data.truth[at]!));
      states.push(this.states[this.state[at]!]!);
      doubt.push(this.names[this.doubt[at]!]!);
      limit.push(this.names[this.limit[at]!]!);
    }
    return { columns, states, doubt, limit };
  }

  /** All that is kept, with the flight recorder's names of columns. */
  csv(): string {
    const rows = ['t_s,meas_m,ref_m,thrust_n,state,flags'];
    const cell = (value: number, digits: number): string => (Number.isNaN(value) ? '' : value.toFixed(digits));
    for (let i = 0; i < this.count; i++) {
      const at = (this.begin + i) % CAPACITY;
      const { t, height, reference, thrust } = this.data;
      rows.push([cell(t[at]! - this.start, 3), cell(height[at]!, 3), cell(reference[at]!, 3), cell(thrust[at]!, 2), this.states[this.state[at]!]!, this.flags[at]!].join(','));
    }
    return `${rows.join('\n')}\n`;
  }
}
