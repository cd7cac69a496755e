import type { Beam, Mirror } from '../protocol/beams';
import { MIRRORS } from '../protocol/beams';
import story from '../story.json';
import { clock, live, parameters, scan } from '../store';
import { language, shown, w } from '../words';

const OLD_MS = 2500; // a line comes each second: two were lost
const LIAR = 50; // percent: the firmware leaves it out
const SPREAD_FEW = 60; // mm, chosen: a floor shows 5 to 30
const DEGREES_PER_STEP = 0.3515625; // 360 / 1024
const FRONT_STEP = 384;
const STEPS: Record<Mirror, [parameter: string, delivered: number]> = { m1: ['S1', 128], mf: ['SF', 389], m2: ['S2', 640] };

export type Judgement = 'unknown' | 'blind' | 'liar' | 'out' | 'wide' | 'good';
export function judge(beam: Beam | null, out: boolean): Judgement {
  if (beam === null) return 'unknown';
  if (Number.isNaN(beam.slant)) return 'blind';
  if (beam.lie > LIAR) return 'liar';
  if (out) return 'out';
  return beam.spread > SPREAD_FEW ? 'wide' : 'good';
}

/** Where this mirror's rays go in the plane of the scan: 0 is the scanner's front, positive to the fore side. */
function direction(mirror: Mirror): number {
  const [name, delivered] = STEPS[mirror];
  const step = Number(parameters.value.find((p) => p.name === name)?.value ?? delivered);
  return ((step - FRONT_STEP) * DEGREES_PER_STEP * Math.PI) / 180;
}

const WIDE = 260;
const HIGH = 150;
const SENSOR = { x: 46, y: HIGH / 2 };
const FULL_MM = 4095; // the scanner's furthest ends at the edge
const FAN = 0.2; // radians to either side: wider than the rays are, to be seen
const point = (angle: number, mm: number): string => {
  const long = Math.sqrt(Math.min(mm, FULL_MM) / FULL_MM); // the root: something near in front of a mirror is seen too
  const reach = Math.abs(Math.sin(angle)) > 0.5 ? HIGH / 2 - 8 : WIDE - SENSOR.x - 14;
  return `${(SENSOR.x + Math.cos(angle) * long * reach).toFixed(1)},${(SENSOR.y - Math.sin(angle) * long * reach).toFixed(1)}`;
};

/** One mirror: a line for each good ray as long as the slant, and a bar at its end as thick as the spread. */
function Fan({ mirror, beam, judgement }: { mirror: Mirror; beam: Beam | null; judgement: Judgement }) {
  const at = direction(mirror);
  const rays = beam ? Math.min(beam.rays, 35) : 0;
  const told = beam !== null && !Number.isNaN(beam.slant);
  const angles = Array.from({ length: rays }, (_, i) => at + FAN * (rays > 1 ? (2 * i) / (rays - 1) - 1 : 0));
  const side = (mm: number, order: 1 | -1): string => [-1, -0.5, 0, 0.5, 1].map((part) => point(at + FAN * part * order, mm)).join(' ');
  return (
    <g class={`fan ${judgement}`} data-mirror={mirror} data-judgement={judgement} data-slant={told ? beam.slant : ''}>
      <polygon class="window" points={`${SENSOR.x},${SENSOR.y} ${side(FULL_MM, 1)}`} />
      {told && angles.map((angle, i) => {
        const [x2, y2] = point(angle, beam.slant).split(',');
        return <line key={i} class="ray" x1={SENSOR.x} y1={SENSOR.y} x2={x2} y2={y2} />;
      })}
      {told && <polygon class="end" points={`${side(Math.max(0, beam.slant - beam.spread / 2), 1)} ${side(beam.slant + beam.spread / 2, -1)}`} />}
      {!told && <text x={point(at, FULL_MM * 0.55).split(',')[0]} y={Number(point(at, FULL_MM * 0.55).split(',')[1]) + 4} text-anchor="middle">{beam === null ? '?' : '×'}</text>}
    </g>
  );
}

/** The scan as the vehicle tells of it once a second: its three groups, who is believed, what holds and what is doubted. */
export function Beams() {
  const words = w();
  const told = scan.value;
  const now = live.value;
  if (!told) return null; // a firmware that tells nothing of them
  const old = now === null || clock.value - told.link > OLD_MS;
  const texts = story[language.value];
  const judged = MIRRORS.map((mirror) => {
    const beam = old ? null : told.beams.mirrors[mirror];
    return { mirror, beam, judgement: judge(beam, told.beams.out.includes(mirror)) };
  });
  const cell = (value: number | undefined): string => shown(value);
  const doubt = now?.doubt ? (texts.reasons as Record<string, string>)[now.doubt] ?? '' : '';
  const limit = now?.limit ? (texts.limits as Record<string, string>)[now.limit] ?? '' : '';
  return (
    <section class={`card beams ${old ? 'stale' : ''}`} aria-labelledby="beams-title">
      <h2 id="beams-title">{words.beamsTitle}</h2>
      <svg class="picture scan" viewBox={`0 0 ${WIDE} ${HIGH}`} role="img" aria-label={judged.map(({ mirror, judgement }) => `${words.mirrorNames[mirror]}: ${words.judgements[judgement]}`).join('; ')}>
        <rect class="body" x={SENSOR.x - 9} y={SENSOR.y - 6} width="10" height="12" rx="3" />
        {judged.map((j) => <Fan key={j.mirror} {...j} />)}
        <text x={WIDE - 4} y={HIGH - 5} text-anchor="end">{words.scanPlane}</text>
      </svg>
      <table>
        <thead><tr><th>{words.mirror}</th><th>{words.goodRays}</th><th>{words.slant}<small>mm</small></th><th>{words.spread}<small>mm</small></th><th>{words.age}<small>ms</small></th><th>{words.lies}<small>%</small></th></tr></thead>
        <tbody>
          {judged.map(({ mirror, beam, judgement }) => (
            <tr key={mirror} data-mirror={mirror}>
              <th scope="row">{words.mirrorNames[mirror]}<small class={judgement}>{words.judgements[judgement]}</small></th>
              <td>{cell(beam?.rays)}</td><td>{cell(beam?.slant)}</td><td>{cell(beam?.spread)}</td><td>{beam?.age === 999 ? '≥ 999' : cell(beam?.age)}</td><td>{cell(beam?.lie)}</td>
            </tr>
          ))}
        </tbody>
      </table>
      {doubt && <p class="banner bad">{words.doubtIs} <code>{now!.doubt}</code>: {doubt}.</p>}
      {limit && <p class="banner">{words.limitIs} <code>{now!.limit}</code>: {limit}.</p>}
      {old && <p class="hint">{words.beamsOld}</p>}
    </section>
  );
}
