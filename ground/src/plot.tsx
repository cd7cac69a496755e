import { useEffect, useRef, useState } from 'preact/hooks';
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { Marks } from './marks';
import type { Mark } from './series';
import type { StoryEvent } from './story';
import { shown, w } from './words';

export interface Curve {
  label: string;
  colour: string; // a CSS variable
  axis: 'm' | 'N' | 'rad';
  dash?: number[];
  width?: number;
  fill?: boolean;
}

export interface PlotData {
  columns: (number | null)[][]; // time first
  states?: string[];
  marks?: Mark[];
  story?: StoryEvent[]; // in the order of time; given at all: the plot has a line that says what is pointed at
  from?: number;
  to?: number;
}

const STATE_COLOURS: Record<string, string> = {
  GROUND: '--state-ground', TAKEOFF: '--state-takeoff', FLYING: '--state-flying', FLOATING: '--state-floating', COASTING: '--state-coasting', DESCENDING: '--state-descending', LANDING: '--state-landing', LOWERING: '--state-lowering', CUT: '--state-cut',
};

function css(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

export function stateColour(state: string): string {
  return css(STATE_COLOURS[state] ?? '--state-ground');
}

const RIBBON = 8;

function drawStates(u: uPlot, states: string[]): void {
  const times = u.data[0];
  const { left, top, width } = u.bbox;
  const ctx = u.ctx;
  ctx.save();
  ctx.beginPath();
  ctx.rect(left, top, width, u.bbox.height);
  ctx.clip();
  const height = RIBBON * devicePixelRatio;
  let begin = 0;
  for (let i = 1; i <= states.length; i++) {
    if (i < states.length && states[i] === states[begin]) continue;
    if (states[begin]) {
      const x0 = u.valToPos(times[begin]!, 'x', true);
      const x1 = i < states.length ? u.valToPos(times[i]!, 'x', true) : u.valToPos(times[i - 1]!, 'x', true);
      ctx.fillStyle = stateColour(states[begin]!);
      ctx.fillRect(x0, top, Math.max(1, x1 - x0), height);
      ctx.font = `600 ${10 * devicePixelRatio}px system-ui, sans-serif`;
      if (ctx.measureText(states[begin]!).width + 12 * devicePixelRatio < x1 - x0) {
        ctx.fillStyle = css('--muted');
        ctx.textBaseline = 'top';
        ctx.textAlign = 'left';
        ctx.fillText(states[begin]!, Math.max(x0, left) + 4 * devicePixelRatio, top + height + 3 * devicePixelRatio);
      }
    }
    begin = i;
  }
  ctx.restore();
}

function drawMarks(u: uPlot, marks: Mark[]): void {
  const ctx = u.ctx;
  const { left, top, width, height } = u.bbox;
  ctx.save();
  ctx.beginPath();
  ctx.rect(left, top, width, height);
  ctx.clip();
  ctx.font = `600 ${11 * devicePixelRatio}px system-ui, sans-serif`;
  ctx.textAlign = 'left';
  ctx.textBaseline = 'bottom';
  let row = 0;
  let before = -Infinity;
  for (const mark of marks) {
    const x = u.valToPos(mark.t, 'x', true);
    if (x < left || x > left + width) continue;
    const colour = css(mark.answered === false ? '--danger' : mark.answered === null ? '--muted' : '--mark');
    ctx.strokeStyle = ctx.fillStyle = colour;
    ctx.lineWidth = devicePixelRatio;
    ctx.setLineDash([3 * devicePixelRatio, 3 * devicePixelRatio]);
    ctx.beginPath();
    ctx.moveTo(x, top);
    ctx.lineTo(x, top + height);
    ctx.stroke();
    row = x - before < 90 * devicePixelRatio ? row + 1 : 0;
    before = x;
    ctx.fillText(mark.text, x + 4 * devicePixelRatio, top + height - (4 + (row % 4) * 14) * devicePixelRatio);
  }
  ctx.restore();
}

/** Draws what `data` gives; `live` is asked for new data a few times a second. */
export function Plot(props: { curves: Curve[]; data: () => PlotData; live?: number; height: number; label: string; ref?: never; hold?: boolean; onPlot?: (u: uPlot) => void; key?: string; xLabel?: string; clock?: boolean }) {
  const host = useRef<HTMLDivElement>(null);
  const [sentence, setSentence] = useState<string | null>(null); // null: the plot tells no story
  const latest = useRef(props);
  latest.current = props;

  useEffect(() => {
    const element = host.current!;
    let zoomed = false;
    let gone = false;
    let current = props.data();
    const marks = current.story ? new Marks(w().storyTitle, setSentence) : null;
    if (marks) {
      element.append(marks.element);
      setSentence('');
    }
    const axes = [...new Set(props.curves.map((c) => c.axis))];
    const axisBase = { stroke: () => css('--muted'), grid: { stroke: () => css('--grid'), width: 1 }, ticks: { show: false }, font: '12px system-ui, sans-serif' };
    const options: uPlot.Options = {
      width: Math.max(200, element.clientWidth),
      height: props.height,
      legend: { show: false },
      cursor: { drag: { x: true, y: false }, points: { size: 7 } },
      scales: {
        x: { time: props.clock === true },
        m: { range: (_u, low, high) => [Math.min(0, low ?? 0), Math.max(0.8, (high ?? 0) * 1.15)] },
        N: { range: (_u, _low, high) => [0, Math.max(9, (high ?? 0) * 1.15)] },
        rad: { range: (_u, low, high) => [Math.min(-0.2, low ?? 0), Math.max(0.2, high ?? 0)] },
      },
      axes: [
        { ...axisBase, size: 28, values: (_u: uPlot, ticks: number[]) => ticks.map((tick) => (props.clock ? new Date(tick * 1000).toTimeString().slice(0, 8) : `${shown(Number(tick.toFixed(2)))} s`)) },
        ...axes.map((axis, i): uPlot.Axis => ({ ...axisBase, scale: axis, side: i === 0 ? 3 : 1, grid: i === 0 ? axisBase.grid : { show: false }, size: 44, values: (_u, ticks) => ticks.map((tick) => `${shown(Number(tick.toFixed(2)))}${axis === 'rad' ? '' : ` ${axis}`}`) })),
      ],
      series: [
        {},
        ...props.curves.map((curve): uPlot.Series => ({
          label: curve.label, scale: curve.axis, stroke: () => css(curve.colour), width: curve.width ?? 2, points: { show: false }, spanGaps: false,
          ...(curve.dash ? { dash: curve.dash } : {}), ...(curve.fill ? { fill: () => css(`${curve.colour}-soft`) } : {}),
        })),
      ],
      hooks: {
        draw: [(u) => {
          if (current.states) drawStates(u, current.states);
          if (current.marks) drawMarks(u, current.marks);
          marks?.place(u, current.story ?? []);
        }],
        setSelect: [(u) => { zoomed = u.select.width > 0; }],
      },
    };
    const plot = new uPlot(options, current.columns as uPlot.AlignedData, element);
    props.onPlot?.(plot);
    plot.over.addEventListener('dblclick', () => (zoomed = false));
    const draw = (): void => {
      if (gone || zoomed || latest.current.hold) return;
      current = latest.current.data();
      plot.batch(() => {
        plot.setData(current.columns as uPlot.AlignedData, current.from === undefined);
        if (current.from !== undefined) plot.setScale('x', { min: current.from, max: current.to! });
      });
    };
    draw();
    const timer = props.live ? setInterval(() => requestAnimationFrame(draw), props.live) : null;
    const resize = new ResizeObserver(() => plot.setSize({ width: Math.max(200, element.clientWidth), height: latest.current.height }));
    resize.observe(element);
    const theme = new MutationObserver(() => plot.redraw(false));
    theme.observe(document.documentElement, { attributes: true });
    return () => {
      if (timer) clearInterval(timer);
      gone = true; // frames that were asked for may still come
      resize.disconnect();
      theme.disconnect();
      plot.destroy();
      marks?.element.remove();
    };
  }, [props.height, props.curves.map((c) => c.label).join(), props.live === undefined ? props.data : null]);

  return (
    <figure class="plot">
      <figcaption class="legend">
        {props.curves.map((curve) => (
          <span key={curve.label}>
            <i style={{ background: `var(${curve.colour})` }} class={curve.dash ? 'dashed' : ''} />
            {curve.label}
          </span>
        ))}
      </figcaption>
      <div ref={host} class="plot-host" role={sentence === null ? 'img' : 'group'} aria-label={props.label} />
      {sentence !== null && <p class="story-line" role="status">{sentence || w().storyHint}</p>}
    </figure>
  );
}

export function saveFile(name: string, content: BlobPart, type = 'text/plain'): void {
  const url = URL.createObjectURL(new Blob([content], { type }));
  const anchor = Object.assign(document.createElement('a'), { href: url, download: name });
  anchor.click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

/** All plots within the element, one below the other. */
export function savePng(element: Element | null, name: string): void {
  const plots = [...(element?.querySelectorAll('canvas') ?? [])];
  if (plots.length === 0) return;
  const picture = Object.assign(document.createElement('canvas'), { width: Math.max(...plots.map((plot) => plot.width)), height: plots.reduce((sum, plot) => sum + plot.height, 0) });
  const ctx = picture.getContext('2d')!;
  ctx.fillStyle = css('--surface');
  ctx.fillRect(0, 0, picture.width, picture.height);
  let top = 0;
  for (const plot of plots) {
    ctx.drawImage(plot, 0, top);
    top += plot.height;
  }
  picture.toBlob((blob) => blob && saveFile(name, blob, 'image/png'));
}

export async function pickFiles(multiple = false): Promise<File[]> {
  return new Promise((resolve) => {
    const input = Object.assign(document.createElement('input'), { type: 'file', multiple });
    input.onchange = () => resolve([...(input.files ?? [])]);
    input.oncancel = () => resolve([]);
    input.click();
  });
}

export function stamp(): string {
  return new Date().toISOString().slice(0, 19).replace(/[:T]/g, '-');
}
