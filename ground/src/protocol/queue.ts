import type { Line } from './lines';

type Answer = Extract<Line, { kind: 'answer' }>;
export type Outcome = { ok: true; lines: Answer[] } | { ok: false; reason: string; silent: boolean; lines: Answer[] };

interface Entry {
  text: string;
  name: string;
  list: boolean;
  tries: number;
  sent: number;
  deadline: number;
  lines: Answer[];
  done: (outcome: Outcome) => void;
}

/** Milliseconds. The firmware answers a command in well under a second; a listing takes its lines' time at 9600 bit/s. */
export const PATIENCE = 2000;
export const LIST_PATIENCE = 4000;
export const TRIES = 3;
export const URGENT_PERIOD = 700;
export const URGENT_PATIENCE = 20_000;

const LISTS = new Set(['GET', 'HELP', 'PERF', 'IMU']);

/** Sends one command at a time, each again until it is answered; gives up and says so after TRIES. Stops go past the queue and
 * are repeated until answered. Time comes from outside (milliseconds of the link's clock). */
export class CommandQueue {
  private waiting: Entry[] = [];
  private current: Entry | null = null;
  private urgent: { name: string; next: number; until: number; done: (answered: boolean) => void }[] = [];

  constructor(
    private readonly send: (text: string) => void,
    private readonly now: () => number,
  ) {}

  /** A command without its line end: `#KP 0.02`. */
  command(text: string, options: { tries?: number } = {}): Promise<Outcome> {
    const [name = '', argument = ''] = text.replace(/^#\s*/, '').toUpperCase().split(/\s+/);
    return new Promise((done) => {
      const asked = name === 'GET' && argument !== '' ? argument : name; // a value is answered by its own name
      this.waiting.push({ text, name: asked, list: LISTS.has(name) && argument === '', tries: options.tries ?? TRIES, sent: 0, deadline: 0, lines: [], done });
      this.tick();
    });
  }

  /** STOP, LAND: at once, before all that waits here; other commands that have not been sent are dropped. */
  stop(name: 'STOP' | 'LAND'): Promise<boolean> {
    for (const entry of this.waiting.splice(0)) entry.done({ ok: false, reason: 'overtaken by a stop', silent: false, lines: entry.lines });
    return new Promise((done) => {
      const now = this.now();
      this.urgent = this.urgent.filter((u) => u.name !== name || (u.done(false), false));
      this.urgent.push({ name, next: now + URGENT_PERIOD, until: now + URGENT_PATIENCE, done });
      this.send(`#${name}`);
    });
  }

  heard(line: Line): void {
    if (line.kind !== 'answer' || line.damaged) return;
    const settled = this.urgent.filter((u) => u.name === line.name && line.ok);
    if (settled.length > 0) {
      this.urgent = this.urgent.filter((u) => !settled.includes(u));
      for (const u of settled) u.done(true);
      if (this.current?.name !== line.name) return;
    }
    const entry = this.current;
    if (!entry || entry.sent === 0) return;
    if (!line.ok && line.name === '-') {
      if (/line damaged|too long|bad character|lost|wrong sum|sum missing/.test(line.rest)) entry.deadline = Math.min(entry.deadline, this.now() + 50); // send it again soon
      return;
    }
    if (entry.name === 'GET' && line.ok && line.name !== 'GET') {
      entry.lines.push(line); // a listing of values names each
      entry.deadline = this.now() + LIST_PATIENCE;
      return;
    }
    const asked = entry.text.toUpperCase().startsWith('#GET') && line.name === 'GET';
    if (line.name !== entry.name && !asked) return;
    if (entry.list && line.ok && !/^END\b/.test(line.rest)) {
      entry.lines.push(line);
      entry.deadline = this.now() + LIST_PATIENCE;
      return;
    }
    if (entry.list && line.ok) {
      const told = Number(/lines:(\d+)/.exec(line.rest)?.[1] ?? NaN);
      if (Number.isFinite(told) && told !== entry.lines.length && entry.tries > 0) {
        entry.deadline = this.now(); // a line was lost: ask again
        this.tick();
        return;
      }
      this.finish({ ok: true, lines: entry.lines });
      return;
    }
    this.finish(line.ok ? { ok: true, lines: [line] } : { ok: false, reason: line.rest, silent: false, lines: [line] });
  }

  /** To be called some times a second. */
  tick(): void {
    const now = this.now();
    for (const u of [...this.urgent]) {
      if (now >= u.until) {
        this.urgent = this.urgent.filter((other) => other !== u);
        u.done(false);
      } else if (now >= u.next) {
        u.next = now + URGENT_PERIOD;
        this.send(`#${u.name}`);
      }
    }
    if (!this.current) this.current = this.waiting.shift() ?? null;
    const entry = this.current;
    if (!entry || (entry.sent > 0 && now < entry.deadline)) return;
    if (entry.tries === 0) {
      this.finish({ ok: false, reason: 'no answer', silent: true, lines: entry.lines });
      return;
    }
    entry.tries--;
    entry.sent++;
    entry.lines = [];
    entry.deadline = now + (entry.list ? LIST_PATIENCE : PATIENCE);
    this.send(entry.text);
  }

  /** The link is gone: nothing will be answered. */
  clear(reason: string): void {
    const all = [...(this.current ? [this.current] : []), ...this.waiting];
    this.current = null;
    this.waiting = [];
    for (const entry of all) entry.done({ ok: false, reason, silent: true, lines: entry.lines });
    for (const u of this.urgent.splice(0)) u.done(false);
  }

  get busy(): boolean {
    return this.current !== null || this.urgent.length > 0;
  }

  private finish(outcome: Outcome): void {
    const entry = this.current!;
    this.current = null;
    entry.done(outcome);
    this.tick();
  }
}
