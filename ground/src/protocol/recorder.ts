import { splitSum } from './sum';

/** Collects one `#LOG` dump, row by row, and what is missing of it. Rows of a later, shorter dump that are the same are one. */
export class LogCollector {
  expected = 0;
  received = 0;
  damaged = 0;
  complete = false;
  private titles = '';
  private rows = new Map<string, { ms: number; number: number }>(); // #LOG RATE FAST: several in one millisecond
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
    this.rows.set(text, { ms: time, number: numbered ? Number(numbered[1]) : 0 });
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
    return this.expected > 0 && !this.hasTitles ? 1 : 0;
  }

  get size(): number {
    return this.rows.size;
  }

  csv(): string {
    const rows = [...this.rows.entries()].sort(([, a], [, b]) => a.ms - b.ms || a.number - b.number);
    return `${[this.titles, ...rows.map(([text]) => text)].join('\n')}\n`;
  }

  get hasTitles(): boolean {
    return this.titles !== '';
  }
}

/** A line of a dump without `OK LOG ` and its sum; null: the sum is wrong, or a row has none. */
export function logRest(line: string): string | null {
  const { text, right } = splitSum(line);
  const rest = /^OK LOG (.*)$/.exec(text)?.[1];
  return rest === undefined || right === false || (right === null && /^\d/.test(rest)) ? null : rest;
}
