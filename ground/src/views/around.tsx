import { SECTORS, type Sector } from '../protocol/around';
import { around, clock, command, drift, live, ofThisVehicle, parameters, phase, scan } from '../store';
import { speedOver } from '../walls';
import { shown, told as inWords, w } from '../words';

const OLD_MS = 1000; // five lines a second: four were lost
const DRIFT_OLD_MS = 2500; // one a second: two were lost
const FULL_MM = 4100; // the furthest that is told
const SIZE = 220;
const MIDDLE = SIZE / 2;
const REACH = MIDDLE - 6;
const SECTOR = (2 * Math.PI) / SECTORS;

/** On the picture: the nose is up, angles go clockwise. */
const point = (angle: number, mm: number): string => `${(MIDDLE + (Math.sin(angle) * mm * REACH) / FULL_MM).toFixed(1)},${(MIDDLE - (Math.cos(angle) * mm * REACH) / FULL_MM).toFixed(1)}`;
const wedge = (index: number, from: number, to: number): string => [point(index * SECTOR, from), point(index * SECTOR, to), point((index + 0.5) * SECTOR, to), point((index + 1) * SECTOR, to), point((index + 1) * SECTOR, from)].join(' ');
const kind = (sector: Sector): string => (typeof sector === 'number' ? 'met' : sector);

/** A sector that met something is free up to there and closed behind; what nobody looks into is hatched. */
function Wedge({ sector, index }: { sector: Sector; index: number }) {
  const data = { class: `sector ${kind(sector)}`, 'data-sector': index, 'data-kind': kind(sector), 'data-mm': typeof sector === 'number' ? sector : '' };
  if (sector === 'unseen') return <polygon {...data} points={wedge(index, 0, FULL_MM)} />;
  if (sector === 'nothing') return <polygon {...data} points={wedge(index, 0, FULL_MM)} />;
  return <polygon {...data} points={wedge(index, sector, FULL_MM)} />;
}

function nearest(sectors: Sector[]): { mm: number; degrees: number } | null {
  const met = sectors.flatMap((sector, i) => (typeof sector === 'number' ? [{ mm: sector, degrees: (i + 0.5) * (360 / SECTORS) }] : []));
  return met.length === 0 ? null : met.reduce((a, b) => (b.mm < a.mm ? b : a));
}

function Speed() {
  const words = w();
  const told = drift.value;
  if (!told || clock.value - told.link > DRIFT_OLD_MS || told.walls.length === 0) return <p class="drift none">{words.driftTitle}: {words.driftNone}</p>;
  const speed = speedOver(told.walls);
  const text = `${shown(speed.mps, 2)} ± ${shown(speed.error, 2)} m/s`;
  return (
    <p class="drift" data-known={speed.known}>
      {words.driftTitle}: <strong>{text}</strong> {speed.known === 'both' ? words.driftBoth(shown(speed.bearing, 0)) : words.driftTowards(shown(speed.bearing, 0))}
      {speed.known === 'one' && <small> {words.driftAlong}</small>}
    </p>
  );
}

const refused = ofThisVehicle(''); // why
async function want(on: boolean): Promise<void> {
  const outcome = await command(`#WALLS ${on ? 'ON' : 'OFF'}`);
  refused.value = outcome.ok ? '' : outcome.silent ? w().noAnswer : inWords(outcome.reason);
  if (outcome.ok && !on) around.value = null;
}

/** What the rays between the mirrors meet, as the vehicle tells five times a second. */
export function Around() {
  const words = w();
  const set = parameters.value.find((p) => p.name === 'WALLS')?.value;
  const told = around.value;
  if (!scan.value && !told) return null; // a firmware that tells nothing of its scans
  if (!told && set !== 'ON') {
    return (
      <section class="card around" aria-labelledby="around-title">
        <h2 id="around-title">{words.aroundTitle}</h2>
        <p class="hint">{words.aroundOff}</p>
        <button disabled={phase.value !== 'open'} onClick={() => void want(true)}>{words.aroundOn}</button>
        {refused.value && <p class="banner bad" role="alert">{words.refused}: {refused.value}</p>}
      </section>
    );
  }
  const age = told ? Math.max(clock.value - told.link, 0) : Infinity;
  const old = live.value === null || age > OLD_MS;
  const sectors: Sector[] = old || !told ? Array<Sector>(SECTORS).fill('unseen') : told.around.sectors;
  const blind = !old && sectors.every((sector) => sector === 'unseen');
  const least = nearest(sectors);
  const near = old ? null : told!.around.near;
  const says = least ? `${shown(least.mm / 1000, 2)} m, ${words.bearing(shown(least.degrees, 0))}` : old || blind ? '–' : words.aroundNone;
  return (
    <section class={`card around ${old ? 'stale' : ''}`} aria-labelledby="around-title">
      <h2 id="around-title">{words.aroundTitle}</h2>
      {near && <p class="banner bad" role="alert">{words.comesNear(shown(near.metres, 2), shown(near.bearing, 0), shown(near.mps, 2))}</p>}
      <svg class="picture" viewBox={`0 0 ${SIZE} ${SIZE}`} role="img" aria-label={`${words.aroundNearest}: ${says}`}>
        <defs><pattern id="unseen" width="5" height="5" patternUnits="userSpaceOnUse" patternTransform="rotate(45)"><line x1="0" y1="0" x2="0" y2="5" class="hatch" /></pattern></defs>
        {sectors.map((sector, index) => <Wedge key={index} sector={sector} index={index} />)}
        {[1000, 2000, 3000, 4000].map((mm) => <circle key={mm} class="ring" cx={MIDDLE} cy={MIDDLE} r={(mm * REACH) / FULL_MM} />)}
        {near && <line class="comes" x1={MIDDLE} y1={MIDDLE} x2={point((near.bearing * Math.PI) / 180, FULL_MM).split(',')[0]} y2={point((near.bearing * Math.PI) / 180, FULL_MM).split(',')[1]} />}
        <polygon class="nose" points={`${MIDDLE},${MIDDLE - 9} ${MIDDLE - 5},${MIDDLE + 5} ${MIDDLE + 5},${MIDDLE + 5}`} />
      </svg>
      <p class="nearest">{words.aroundNearest}: <strong>{says}</strong> · {words.aroundAge}: {told ? shown(age / 1000, 1) : '–'} s</p>
      <Speed />
      {blind && <p class="banner">{words.aroundBlind}</p>}
      {old && <p class="hint">{words.aroundOld}</p>}
      <p class="hint">{words.aroundHint}</p>
      <button class="quiet" disabled={phase.value !== 'open'} onClick={() => void want(false)}>{words.aroundHide}</button>
    </section>
  );
}
