import type uPlot from 'uplot';
import type { StoryEvent } from './story';

const ROWS = 3;
const NEAR = 20; // pixels: closer marks stand in another row
const TOP = 26; // below the states and their names

/** The events of a flight on a plot, as buttons: pointed at by the mouse, or one after the other by Tab and the arrow keys. */
export class Marks {
  private readonly box = document.createElement('div');
  private readonly buttons = new Map<string, HTMLButtonElement>();
  private current = ''; // the one that Tab comes to

  constructor(label: string, private readonly say: (sentence: string) => void) {
    this.box.className = 'story-marks';
    this.box.setAttribute('role', 'group');
    this.box.setAttribute('aria-label', label);
    this.box.addEventListener('keydown', (event) => this.key(event));
  }

  get element(): HTMLElement {
    return this.box;
  }

  /** Puts each event where the plot has its time; what is no longer there goes. */
  place(u: uPlot, events: StoryEvent[]): void {
    const scale = devicePixelRatio;
    const left = u.bbox.left / scale;
    const width = u.bbox.width / scale;
    const ends = new Array<number>(ROWS).fill(-Infinity);
    const seen = new Set<string>();
    const count = new Map<string, number>();
    for (const event of events) {
      const x = u.valToPos(event.t, 'x');
      if (!(x >= 0 && x <= width)) continue;
      const name = `${event.kind}@${event.t}`;
      const nth = count.get(name) ?? 0;
      count.set(name, nth + 1);
      const key = `${name}#${nth}`;
      seen.add(key);
      const row = Math.max(0, ends.findIndex((end) => x - end >= NEAR));
      ends[row] = x;
      const mark = this.buttons.get(key) ?? this.make(key, event.kind);
      mark.style.left = `${left + x}px`;
      mark.style.top = `${TOP + row * NEAR}px`;
      mark.style.setProperty('--below', `${Math.max(0, u.bbox.height / scale - TOP - row * NEAR)}px`);
      if (mark.getAttribute('aria-label') !== event.text) {
        mark.setAttribute('aria-label', event.text);
        if (mark.matches(':hover, :focus')) this.say(event.text);
      }
    }
    for (const [key, mark] of this.buttons) {
      if (seen.has(key)) continue;
      mark.remove();
      this.buttons.delete(key);
    }
    this.tabStop();
  }

  private make(key: string, kind: string): HTMLButtonElement {
    const mark = Object.assign(document.createElement('button'), { className: `story-mark ${kind}` });
    mark.dataset.kind = kind;
    const told = (): void => this.say(mark.getAttribute('aria-label') ?? '');
    mark.addEventListener('mouseenter', told);
    mark.addEventListener('click', told);
    mark.addEventListener('focus', () => {
      this.current = key;
      this.tabStop();
      told();
    });
    this.buttons.set(key, mark);
    this.box.append(mark);
    return mark;
  }

  private inOrder(): [string, HTMLButtonElement][] {
    return [...this.buttons].sort(([, a], [, b]) => parseFloat(a.style.left) - parseFloat(b.style.left) || parseFloat(a.style.top) - parseFloat(b.style.top));
  }

  private tabStop(): void {
    const stop = this.buttons.has(this.current) ? this.current : this.inOrder()[0]?.[0];
    for (const [key, mark] of this.buttons) mark.tabIndex = key === stop ? 0 : -1;
  }

  private key(event: KeyboardEvent): void {
    const order = this.inOrder();
    const at = order.findIndex(([, mark]) => mark === document.activeElement);
    const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: order.length - 1 }[event.key];
    if (at < 0 || to === undefined) return;
    event.preventDefault();
    order[Math.min(Math.max(to, 0), order.length - 1)]![1].focus();
  }
}
