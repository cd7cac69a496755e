import { splitSum } from './sum';

export interface Dump {
  titles: string;
  rows: Map<string, string>; // by their time, in the order of time once written
}

/** Collects one `#LOG` dump, row by row, and what is missing of it. Rows of a later, shorter dump join by their time. */
export class LogCollector {
  expected = 0;
  received = 0;
  damaged = 0;
  complete = false;
  private titles = '';
  private rows = new Map<number, string>(); // by time in ms
  private numbers = new Map<number, number>(); // row number of the dump in hand -> ms
  private base = 0;

  /** The part of an answer behind `OK LOG `, not yet freed of its sum. */
  heard(rest: string): void {
    const begin = /^records:(\d+)$/.exec(rest);
    if (begin) {
      this.expected = Number(begin[1]);
      this.received = 0;
      this.complete = false;
      this.numbers = new Map();
      return;
    }
    if (/^END\b/.test(rest)) {
      this.complete = true;
      return;
    }
    this.row(rest);
  }

  private row(rest: string): void {
    const numbered = /^(\d+) (.*)$/.exec(rest);
    const text = numbered ? numbered[2]! : rest;
    if (text.startsWith('t_s,')) {
      this.titles = text;
      return;
    }
    const time = Math.round(parseFloat(text) * 1000);
    if (!/^\d+(\.\d+)?,/.test(text) || !Number.isFinite(time)) {
      this.damaged++;
      return;
    }
    this.received++;
    if (numbered) this.numbers.set(Number(numbered[1]), time);
    this.rows.set(time, text);
    this.base = Math.max(this.base, time);
  }

  /** How far before the newest row the oldest missing one lies, in whole seconds; 0: nothing is missing. */
  missingSeconds(): number {
    if (this.numbers.size === 0) return this.expected > 0 ? 3600 : 0;
    for (let number = 1; number <= this.expected; number++) {
      if (this.numbers.has(number)) continue;
      let before = number - 1;
      while (before > 0 && !this.numbers.has(before)) before--;
      const from = before > 0 ? this.numbers.get(before)! : Math.min(...this.numbers.values()) - 100 * number;
      return Math.min(3600, Math.ceil((this.base - from) / 1000) + 2);
    }
    return 0;
  }

  get size(): number {
    return this.rows.size;
  }

  csv(): string {
    const titles = this.titles || 't_s,meas_m,est_m,innov_m,ref_m,thrust_n,roll_rad,pitch_rad,state,flags';
    return `${titles}\n${[...this.rows.entries()].sort((a, b) => a[0] - b[0]).map(([, text]) => text).join('\n')}\n`;
  }
}

/** A whole line of a dump whose sum is wrong must not be used. */
export function logRest(line: string): string | null {
  const match = /^OK LOG (.*)$/.exec(line);
  if (!match) return null;
  // The firmware sums all characters before the '*', of the line or of the row: both are accepted.
  const whole = splitSum(line);
  if (whole.right === null) return match[1]!;
  if (whole.right) return /^OK LOG (.*)$/.exec(whole.text)![1]!;
  const part = splitSum(match[1]!);
  return part.right ? part.text : null;
}
