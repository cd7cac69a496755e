import type { Recording } from '../protocol/logs';
import { Plot, type Curve } from '../plot';
import { story } from '../story';
import { language, shown, w } from '../words';
import { Why } from './why';

const CURVES: { column: string; axis: Curve['axis']; colour: string; dash?: number[]; word: 'measured' | 'estimated' | 'reference' | 'truth' }[] = [
  { column: 'meas_m', axis: 'm', colour: '--curve-height', word: 'measured' },
  { column: 'est_m', axis: 'm', colour: '--curve-thrust', word: 'estimated' },
  { column: 'ref_m', axis: 'm', colour: '--curve-reference', dash: [6, 4], word: 'reference' },
  { column: 'height_m', axis: 'm', colour: '--curve-truth', word: 'truth' },
];
const OTHERS = ['--curve-other-1', '--curve-other-2', '--curve-other-3'];

/** Several recordings over one time axis; the first one in full, of the others height and thrust. */
export function RecordingPlots({ recordings }: { recordings: Recording[] }) {
  const words = w();
  const [first, ...others] = recordings;
  if (!first) return null;
  const zero = (r: Recording): number => r.time[0] ?? 0;
  const times = [...new Set(recordings.flatMap((r) => r.time.map((t) => Math.round((t - zero(r)) * 1000))))].sort((a, b) => a - b);
  const place = (r: Recording, column: string): (number | null)[] => {
    const values = r.columns[column] ?? [];
    const at = new Map(r.time.map((t, i) => [Math.round((t - zero(r)) * 1000), values[i]]));
    let before: number | null = null;
    let since = 0;
    return times.map((t) => {
      const value = at.get(t);
      if (value !== undefined) {
        before = Number.isNaN(value) ? null : value;
        since = t;
      } else if (t - since > 300) before = null;
      return before;
    });
  };
  const seconds = times.map((t) => t / 1000);
  const heights = CURVES.filter((c) => first.columns[c.column]?.some((v) => !Number.isNaN(v)));
  const heightCurves: Curve[] = [
    ...heights.map((c) => ({ label: words[c.word], colour: c.colour, axis: c.axis, ...(c.dash ? { dash: c.dash } : {}) })),
    ...others.map((r, i) => ({ label: r.name, colour: OTHERS[i % 3]!, axis: 'm' as const, width: 1.5 })),
  ];
  const statesAt = new Map(first.time.map((t, i) => [Math.round((t - zero(first)) * 1000), first.states[i]!]));
  let state = '';
  const states = times.map((t) => (state = statesAt.get(t) ?? state));
  const heightData = { columns: [seconds, ...heights.map((c) => place(first, c.column)), ...others.map((r) => place(r, 'height_m' in r.columns ? 'height_m' : 'meas_m'))], states, story: story(first, language.value, shown).map((event) => ({ ...event, t: event.t - zero(first) })) };
  const thrustData = { columns: [seconds, ...recordings.map((r) => place(r, 'thrust_n'))] };
  const thrustCurves = recordings.map((r, i): Curve => ({ label: i === 0 ? words.thrust : r.name, colour: i === 0 ? '--curve-thrust' : OTHERS[(i - 1) % 3]!, axis: 'N' }));
  const key = `${language.value}${recordings.map((r) => `${r.name}${r.time.length}`).join()}`;
  return (
    <div key={key}>
      <Plot curves={heightCurves} data={() => heightData} height={300} label={words.height} />
      <Plot curves={thrustCurves} data={() => thrustData} height={160} label={words.thrust} />
      {'roll_rad' in first.columns && (
        <Plot curves={[{ label: words.roll, colour: '--curve-other-1', axis: 'rad' }, { label: words.pitch, colour: '--curve-other-2', axis: 'rad' }]} data={() => ({ columns: [seconds, place(first, 'roll_rad'), place(first, 'pitch_rad')] })} height={130} label={words.attitude} />
      )}
      <Why recording={first} />
      {recordings.flatMap((r) => r.notes.map((note) => <p class="hint" key={r.name + note.kind}>{r.name}: {words.notes[note.kind]}: {note.count}</p>))}
    </div>
  );
}
