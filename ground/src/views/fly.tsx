import { signal } from '@preact/signals';
import { useRef } from 'preact/hooks';
import { keep, keptAs } from '../keep';
import { Plot, saveFile, savePng, stamp } from '../plot';
import { batteryNow, clock, command, live, ofThisVehicle, phase, powerCycle, seen, series, vehicle } from '../store';
import { storyOf } from '../story';
import { ago, language, shown, told, w } from '../words';
import { Around } from './around';
import { Beams } from './beams';
import { Picture, Places } from './place';
import { Troubles } from './troubles';

const wanted = signal(keptAs('reference', (text) => (Number(text) >= 0.1 && Number(text) <= 3 ? text : null), '0.6'));
const span = signal(60);
const held = signal(false);
const tick = signal(0); // what the simulation's buttons change

function Number3({ label, value, unit, sub, tone }: { label: string; value: string; unit?: string; sub?: string; tone?: string }) {
  return (
    <div class={`big ${tone ?? ''}`}>
      <span class="big-label">{label}</span>
      <span class="big-value">{value}{unit && <small>{unit}</small>}</span>
      <span class="big-sub">{sub ?? '\u00a0'}</span>
    </div>
  );
}

export function Numbers() {
  const now = seen.value;
  const words = w();
  const t = now.kind === 'nothing' ? null : now.telemetry;
  /** What stands below a number: how old it is, as soon as it is not of now. */
  const sub = (fresh: string): string => (now.kind === 'old' ? ago(now.age) : fresh);
  const tone = (fresh: string | false | null | undefined): string => (now.kind === 'live' && fresh ? fresh : '');
  const connection = phase.value === 'open' || phase.value === 'lost' ? phase.value : 'idle';
  return (
    <section class={`numbers ${now.kind === 'live' ? '' : 'stale'}`} aria-label={now.kind === 'live' ? words.live : words.link}>
      <Number3 label={words.height} value={shown(t?.height, 2)} unit="m" sub={sub(`${words.reference} ${t && t.reference > 0 ? `${shown(t.reference, 2)} m` : words.none}`)} tone="primary" />
      <Number3 label={words.thrust} value={shown(t?.thrust, 1)} unit="N" sub={sub(batteryNow.value ? `${words.perMotor} · ${shown(batteryNow.value.volts, 1)} V` : words.perMotor)} />
      <Number3 label={words.state} value={t?.state ?? '–'} sub={sub(t ? words.states[t.state] ?? '' : '')} tone={`word ${tone(t && (['CUT', 'DESCENDING', 'LOWERING'].includes(t.state) ? 'bad' : t.state !== 'GROUND' && 'good'))}`} />
      <Number3 label={words.laser} value={t?.laser ?? '–'} sub={sub(t ? words.lasers[t.laser] ?? '' : '')} tone={`word ${tone(t?.laser === 'OK' ? 'good' : t?.laser === 'LOST' && 'bad')}`} />
      <Number3 label={words.link} value={t ? shown(now.age / 1000, 1) : '–'} unit="s" sub={now.kind === 'old' ? `${connection === 'open' ? '' : `${words[connection]} · `}${ago(now.age)}` : words[connection]} tone={now.kind === 'old' ? 'bad' : ''} />
    </section>
  );
}

export function Messages() {
  const now = seen.value;
  const words = w();
  if (now.kind === 'nothing') return null;
  const { flags: bits, state, reference } = now.telemetry;
  const flags: [string, string][] = state === 'GROUND' && reference > 0 ? [words.waitsToTakeOff(shown(reference, 2))] : [];
  const battery = batteryNow.value;
  if (battery?.word) flags.push(words.batteryWords[battery.word] ?? words.batteryWord(battery.word, shown(battery.volts, 1)));
  for (let bit = 0; bit < 16; bit++) if (bits & (1 << bit)) flags.push(words.flags[bit] ?? words.unknownFlag(1 << bit));
  if (now.kind === 'old') {
    return (
      <ul class="messages">
        <li class="alone"><strong>{words.notLive(ago(now.age))}</strong></li>
        <li class="past"><strong>{state}</strong><span>{words.states[state] ?? ''}</span></li>
        {flags.map(([what]) => (<li class="past" key={what}><strong>{what}</strong></li>))}
      </ul>
    );
  }
  return (
    <ul class="messages" aria-live="polite">
      {flags.map(([what, todo]) => (
        <li class="warn" key={what}><strong>{what}</strong><span>{todo}</span></li>
      ))}
      {flags.length === 0 && (
        <li class="fine"><strong>{words.allWell}</strong><span>{state === 'GROUND' ? words.allWellDo : words.states[state] ?? words.flyingWell}</span></li>
      )}
    </ul>
  );
}

const notArmed = ofThisVehicle(''); // why
async function arm(): Promise<void> {
  notArmed.value = '';
  const outcome = await command('#ARM');
  if (!outcome.ok) notArmed.value = outcome.silent ? w().noAnswer : told(outcome.reason);
}

const replied = ofThisVehicle<{ text: string; bad: boolean } | null>(null); // to the latest reference

function Reference() {
  const words = w();
  const t = live.value;
  const open = phase.value === 'open' && seen.value.kind !== 'nothing'; // a silent vehicle may still hear
  const grounded = t?.state === 'GROUND';
  const flying = t !== null && !grounded;
  const seesGround = t?.laser === 'OK' && (t.flags & 1) === 0;
  const send = (): void => {
    keep('reference', wanted.value);
    replied.value = null;
    void command(`#SETR ${Number(wanted.value)}`).then((outcome) => {
      const remark = outcome.ok ? /\((.*)\)$/.exec(outcome.lines[0]?.rest ?? '')?.[1] ?? '' : outcome.reason;
      replied.value = remark === '' ? null : { text: outcome.ok ? told(remark) : `${words.refused}: ${told(remark)}`, bad: !outcome.ok };
    });
  };
  return (
    <section class="card reference" aria-labelledby="reference-title">
      <h2 id="reference-title">{words.flyTo}</h2>
      <div class="stepper">
        <button aria-label={`−${shown(0.1)} m`} onClick={() => (wanted.value = Math.max(0.1, Number(wanted.value) - 0.1).toFixed(1))}>−</button>
        <output>{shown(Number(wanted.value), 1)}<small> m</small></output>
        <button aria-label={`+${shown(0.1)} m`} onClick={() => (wanted.value = Math.min(3, Number(wanted.value) + 0.1).toFixed(1))}>+</button>
      </div>
      <div class="presets">
        {['0.3', '0.6', '1.0', '1.5'].map((value) => (
          <button key={value} class={value === wanted.value ? 'chosen' : ''} aria-pressed={value === wanted.value} onClick={() => (wanted.value = value)}>{shown(value)}</button>
        ))}
      </div>
      <button class="go" disabled={!open} onClick={send}>{flying ? `${words.changeTo} ${shown(Number(wanted.value), 1)} m` : grounded && !seesGround ? words.takeOffLater : words.takeOff}</button>
      {replied.value && <p class={`banner ${replied.value.bad ? 'bad' : ''}`} role="alert">{replied.value.text}</p>}
      {!vehicle.value && <><button disabled={t?.state !== 'GROUND'} onClick={() => void arm()}>{words.arm}{grounded && t.thrust > 0 && <small> · {words.motorsIdle}</small>}</button>{notArmed.value && <p class="banner bad" role="alert">{words.refused}: {notArmed.value}</p>}<p class="hint">{words.armHint}</p><ol class="hint">{Object.entries(words.armSteps).map(([step, text]) => (<li key={step}>{text}</li>))}</ol></>}
    </section>
  );
}

export function Simulation() {
  const v = vehicle.value;
  void tick.value;
  const words = w();
  if (!v) return null;
  const act = (what: () => void) => () => {
    what();
    tick.value++;
  };
  return (
    <section class="card simulation" aria-labelledby="simulation-title">
      <h2 id="simulation-title">{words.simPanel}</h2>
      <Picture vehicle={v} />
      <Places vehicle={v} changed={() => tick.value++} />
      {live.value?.laser !== 'OK' && live.value?.state === 'GROUND' && v.laser && <p class="hint">{words.firstSteps}</p>}
      <div class="row" role="group" aria-label={words.speed}>
        <span class="row-label">{words.speed}</span>
        {[0.25, 1, 2, 5].map((speed) => (
          <button key={speed} class={`chip ${v.speed === speed ? 'chosen' : ''}`} aria-pressed={v.speed === speed} onClick={act(() => (v.speed = speed))}>{shown(speed)}×</button>
        ))}
      </div>
      <div class="faults" role="group" aria-label={words.faults}>
        <button class={v.laser ? '' : 'broken'} onClick={act(() => v.setLaser(!v.laser))}>{v.laser ? words.unplugLaser : words.plugLaser}</button>
        <button class={v.imu ? '' : 'broken'} onClick={act(() => v.setImu(!v.imu))}>{v.imu ? words.unplugImu : words.plugImu}</button>
        <button class={v.radio ? '' : 'broken'} onClick={act(() => v.setRadio(!v.radio))}>{v.radio ? words.cutRadio : words.mendRadio}</button>
        <button onClick={act(() => v.troubleLaser())}>{words.laserTrouble}</button>
        <button onClick={act(() => v.go())}>{v.place === 'floor' ? words.ramp : words.goTheWay}</button>
        <button class={v.pilot ? 'broken' : ''} onClick={act(() => v.setPilot(!v.pilot))}>{v.pilot ? words.pilotGives : words.pilotTakes}</button>
      </div>
      <Troubles vehicle={v} changed={() => tick.value++} />
      <button class="quiet" onClick={act(powerCycle)}>{words.powerCycle}</button>
    </section>
  );
}

export function FlyView() {
  const words = w();
  const plots = useRef<HTMLDivElement>(null);
  const withTruth = vehicle.value !== null; // curves and columns are of one mind, also while the link changes
  const curves = [
    { label: words.measured, colour: '--curve-height', axis: 'm' as const, width: 2.5, fill: true },
    { label: words.reference, colour: '--curve-reference', axis: 'm' as const, dash: [6, 4] },
    ...(withTruth ? [{ label: words.truth, colour: '--curve-truth', axis: 'm' as const, width: 1.5 }] : []),
  ];
  const range = (): [number, number] => {
    const end = clock.peek() === 0 ? series.end : clock.peek() / 1000; // a session from before a reload has no clock
    return span.peek() === 0 ? [Math.min(series.start, end - 1), end] : [end - span.peek(), end];
  };
  const heights = () => {
    const [from, to] = range();
    const { columns, states, doubt, limit } = series.window(from, to);
    const numbers = (column: (number | null)[]): number[] => column.map((value) => value ?? NaN);
    const heard = states.map((_, i) => i).filter((i) => states[i] !== ''); // not the gaps
    const story = storyOf({ time: heard.map((i) => columns[0]![i]!), states: heard.map((i) => states[i]!), reference: heard.map((i) => columns[2]![i] ?? 0), height: numbers(heard.map((i) => columns[1]![i]!)), doubt: heard.map((i) => doubt[i]!), limit: heard.map((i) => limit[i]!), out: [] }, language.peek(), false, shown);
    return { columns: [columns[0]!, columns[1]!, columns[2]!, ...(withTruth ? [columns[4]!] : [])], states, marks: series.marks, story, from, to };
  };
  const thrusts = () => {
    const [from, to] = range();
    const { columns } = series.window(from, to);
    return { columns: [columns[0]!, columns[3]!], from, to };
  };
  return (
    <div class="fly">
      <div class="fly-main">
        <Numbers />
        <Messages />
        <section class="card plots live-plots" ref={plots} aria-label={`${words.height}, ${words.thrust}`}>
          <div class="plot-tools">
            <span class="row-label">{words.window}</span>
            {([[20, '20 s'], [60, '1 min'], [300, '5 min'], [0, '∞']] as const).map(([seconds, label]) => (
              <button key={label} class={`chip ${span.value === seconds ? 'chosen' : ''}`} aria-pressed={span.value === seconds} onClick={() => (span.value = seconds)}>{label}</button>
            ))}
            <button class={`chip ${held.value ? 'chosen' : ''}`} aria-pressed={held.value} onClick={() => (held.value = !held.value)}>{words.hold}</button>
            <span class="spacer" />
            <button class="quiet" onClick={() => saveFile(`plomada-${stamp()}.csv`, series.csv(), 'text/csv')}>{words.saveCsv}</button>
            <button class="quiet" onClick={() => savePng(plots.current, `plomada-${stamp()}.png`)}>{words.savePng}</button>
          </div>
          <Plot key={`h${withTruth ? 1 : 0}${language.value}`} curves={curves} data={heights} live={100} hold={held.value} height={300} label={words.height} clock />
          <Plot curves={[{ label: words.thrust, colour: '--curve-thrust', axis: 'N', fill: true }]} data={thrusts} live={100} hold={held.value} height={150} label={words.thrust} clock />
          <p class="hint">{words.zoomHint}</p>
        </section>
      </div>
      <aside class="fly-side">
        <Reference />
        <Beams />
        <Around />
        <Simulation />
      </aside>
    </div>
  );
}
