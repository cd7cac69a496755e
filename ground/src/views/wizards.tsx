import { useEffect } from 'preact/hooks';
import { signal } from '@preact/signals';
import { battery, batteryLimits, CELLS, CELLS_MOST } from '../battery';
import { keep, keptAs } from '../keep';
import { heightSeen, LIFTED_M, NO_LIFT, rise, type Lift } from '../lift';
import { typed } from '../protocol/decimal';
import { batteryNow, borrowLink, command, giveBackLink, listeners, live, ofThisVehicle, parameters, phase, readParameters, stop, storeLine } from '../store';
import type { Line } from '../protocol/lines';
import { shown, told, w } from '../words';

const volts = ofThisVehicle('');
const byHand = ofThisVehicle<Record<string, boolean>>({});
const tied = ofThisVehicle(false);
const calibration = ofThisVehicle<{ running: boolean; thrust: string; grav: string; end: string; rise: number }>({ running: false, thrust: '', grav: '', end: '', rise: NaN });
const imu = ofThisVehicle<{ step: string; text: string; bad: boolean }[]>([]);

/** The link is armed for so long: a page that dies ends the calibration in that time. */
const LINK_S = 3;
const cells = signal(keptAs('cells', (text) => (Number(text) >= 2 && Number(text) <= CELLS_MOST ? Math.round(Number(text)) : null), CELLS));
let lift: Lift = NO_LIFT;

/** What the vehicle measures, if it does; else what was typed. */
function batteryIs(): ReturnType<typeof battery> {
  const told = batteryNow.value;
  if (told?.word) return told.word === 'HIGH' ? 'many' : 'low';
  return battery(cells.value, told ? told.volts : Number(typed(volts.value)));
}

export function checks(): Record<string, boolean> {
  const t = live.value;
  const has = (bit: number): boolean => t !== null && (t.flags & bit) === 0;
  return {
    link: t !== null,
    laser: t?.laser === 'OK',
    height: t !== null && !Number.isNaN(t.height) && t.height < 0.1,
    imu: has(2),
    upright: has(32),
    ground: t?.state === 'GROUND' && t.reference === 0,
    flags: t !== null && t.flags === 0,
    settings: t !== null && parameters.value.length > 0 && !(storeLine.value ?? '').startsWith('ERR'),
    tilt: byHand.value.tilt === true || parameters.value.some((p) => p.name === 'IAXES' && p.value === 'PROVED'),
    battery: batteryIs() === 'good',
  };
}

function Checklist() {
  const words = w();
  const state = checks();
  const limits = batteryLimits(cells.value);
  const open = Object.values(state).filter((ok) => !ok).length;
  useEffect(() => {
    if (phase.value === 'open' && parameters.value.length === 0) void readParameters();
  }, [phase.value]);
  return (
    <section class="card" aria-labelledby="checks-title">
      <div class="head"><h2 id="checks-title">{words.checklist}</h2><span class="spacer" /><span class={`tag ${open === 0 ? 'good' : 'accent'}`} role="status">{open === 0 ? words.ready : words.notReady(open)}</span></div>
      <p class="hint">{words.checkText}</p>
      <ul class="checks">
        {Object.entries(words.checks).map(([name, [title, text]]) => (
          <li key={name} class={state[name] ? 'done' : ''}>
            <span class="tick" aria-hidden="true">{state[name] ? '✓' : ''}</span>
            <div><strong>{title}</strong><small>{name === 'battery' ? words.batteryNeeds(shown(limits.least, 1), shown(limits.most, 1)) : text}</small>{name === 'battery' && <small class="problem">{words.batteryIs[batteryIs()]}</small>}</div>
            <span class="visually-hidden">{state[name] ? '✓' : '–'}</span>
            {name === 'tilt' && <label class="check"><input type="checkbox" checked={byHand.value.tilt === true} onChange={(event) => (byHand.value = { ...byHand.value, tilt: event.currentTarget.checked })} /> {words.doneByHand}</label>}
            {name === 'battery' && (
              <span class="row">
                <select aria-label={words.cellsLabel} value={cells.value} onChange={(event) => {
                  cells.value = Number(event.currentTarget.value);
                  keep('cells', String(cells.value));
                }}>{Array.from({ length: CELLS_MOST - 1 }, (_, i) => (<option key={i} value={i + 2}>{words.cells(i + 2)}</option>))}</select>
                <input class="short" inputMode="decimal" aria-label={title} placeholder="V" disabled={batteryNow.value !== null} value={batteryNow.value ? shown(batteryNow.value.volts, 1) : volts.value} onInput={(event) => (volts.value = event.currentTarget.value)} />
              </span>
            )}
          </li>
        ))}
      </ul>
    </section>
  );
}

function heardCalibration(line: Line): void {
  if (line.kind === 'telemetry') lift = heightSeen(lift, line.telemetry.height);
  if (line.kind !== 'answer' || line.name !== 'CALIBRATE') return;
  const thrust = /thr:([\d.]+)/.exec(line.rest)?.[1] ?? calibration.value.thrust;
  const end = /end:(\w+)/.exec(line.rest)?.[1] ?? (line.ok ? '' : line.rest);
  const grav = /grav:([\d.]+)/.exec(line.rest)?.[1] ?? calibration.value.grav;
  calibration.value = { ...calibration.value, running: end === '' && calibration.value.running, thrust, grav, end };
}

function Calibration() {
  const words = w();
  const c = calibration.value;
  const blind = c.running && live.value === null;
  const finish = (end: string): void => {
    if (!calibration.value.running) return;
    calibration.value = { ...calibration.value, running: false, end, rise: rise(lift) }; // what follows is a fall
    void stop('STOP');
  };
  useEffect(() => {
    if (blind) finish('silent'); // nobody may raise a thrust that he does not see
  }, [blind]);
  useEffect(() => {
    if (!c.running) return undefined;
    const halt = (): void => finish('');
    listeners.add(heardCalibration);
    window.addEventListener('keydown', halt, true);
    window.addEventListener('pointerdown', halt, true);
    window.addEventListener('blur', halt);
    document.addEventListener('visibilitychange', halt);
    return () => {
      void giveBackLink();
      setTimeout(() => listeners.delete(heardCalibration), 1500); // the last word comes behind the stop
      window.removeEventListener('keydown', halt, true);
      window.removeEventListener('pointerdown', halt, true);
      window.removeEventListener('blur', halt);
      document.removeEventListener('visibilitychange', halt);
    };
  }, [c.running]);
  const begin = async (): Promise<void> => {
    calibration.value = { running: false, thrust: '', grav: '', end: '', rise: NaN };
    const asked = await command('#GET LINK');
    borrowLink(asked.lines[0]?.rest.split(' ')[0] ?? '0');
    const armed = await command(`#LINK ${LINK_S}`);
    if (!armed.ok) {
      calibration.value = { ...calibration.value, end: armed.reason };
      return;
    }
    const begun = await command('#CALIBRATE', { tries: 1 });
    if (!begun.ok) void giveBackLink();
    lift = NO_LIFT;
    calibration.value = begun.ok ? { running: true, thrust: '0', grav: '', end: '', rise: NaN } : { ...calibration.value, end: begun.reason };
  };
  return (
    <section class={`card ${c.running ? 'alarm' : ''}`} aria-labelledby="calibration-title">
      <h2 id="calibration-title">{words.calibration}</h2>
      <p>{words.calibrationText}</p>
      {c.running ? (
        <div role="alert"><p class="shout">{words.calibrationRunning}</p><p class="big-value">{shown(c.thrust)}<small> N</small></p></div>
      ) : (
        <>
          <label class="check"><input type="checkbox" checked={tied.value} onChange={(event) => (tied.value = event.currentTarget.checked)} /> {words.calibrationBound}</label>
          <button class="primary" disabled={!tied.value || phase.value !== 'open' || live.value?.state !== 'GROUND'} onClick={() => void begin()}>{words.calibrationGo}</button>
          {c.end && <p class="banner" role="status">{words.calibrationEnd(words.calibrationEnds[c.end] ?? told(c.end), c.thrust === '' ? '–' : shown(c.thrust))}</p>}
          {c.end && Number(c.grav) > 0 && (c.rise >= LIFTED_M ? <button onClick={() => void command(`#GRAV ${c.grav}`)}>{words.setGrav(shown(c.grav))}</button> : <p class="banner">{words.noHover(shown(c.grav), shown(c.rise, 2))}</p>)}
        </>
      )}
    </section>
  );
}

function ImuSigns() {
  const words = w();
  const ask = async (argument: string): Promise<void> => {
    const outcome = await command(argument ? `#IMU ${argument}` : '#IMU');
    const text = outcome.ok ? outcome.lines.map((line) => line.text).join('\n') : outcome.reason.startsWith('unknown command') ? words.imuNone : outcome.silent ? w().noAnswer : told(outcome.reason);
    imu.value = [...imu.value, { step: argument || '#IMU', text, bad: !outcome.ok }].slice(-6);
  };
  return (
    <section class="card" aria-labelledby="imu-title">
      <h2 id="imu-title">{words.imuSigns}</h2>
      <p>{words.imuText}</p>
      <div class="row">
        {Object.entries(words.imuSteps).map(([name, text]) => (<button key={name} disabled={phase.value !== 'open'} onClick={() => void ask(name)}>{text}</button>))}
        <button class="quiet" disabled={phase.value !== 'open'} onClick={() => void ask('')}>{words.imuAsk}</button>
      </div>
      <ul class="answers" aria-live="polite">{imu.value.map((line, i) => (<li key={i} class={line.bad ? 'bad' : ''}><strong>{line.step}</strong> <code>{line.text}</code></li>))}</ul>
    </section>
  );
}

export function WizardsView() {
  return (
    <div class="two even">
      <Checklist />
      <div class="stack"><Calibration /><ImuSigns /></div>
    </div>
  );
}
