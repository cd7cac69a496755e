import { signal } from '@preact/signals';
import { useState } from 'preact/hooks';
import type { Figure, VehicleLink } from '../link/vehicle';
import { typed } from '../protocol/decimal';
import { shown, w } from '../words';

const NOW = Symbol('now'); // seconds since power-on
const FOR_GOOD = 1e9;
type Setting = [figure: string, value: number | typeof NOW];

/** What can go wrong at a click; the words are `troubles` of the texts. `once`: it ends by itself. */
export const TROUBLES: { name: string; set: Setting[]; once?: boolean }[] = [
  { name: 'raysLost', set: [['rays_lost', 0.6]] },
  { name: 'blocked', set: [['block_mm', 500], ['sight_blocked', 1]] },
  { name: 'scanFrozen', set: [['scan_frozen_start', NOW], ['scan_frozen_length', FOR_GOOD]] },
  { name: 'glitches', set: [['glitches', 0.1]] },
  { name: 'outage', set: [['outage_start', NOW], ['outage', 1]], once: true },
  { name: 'restart', set: [['scanner_restart_start', NOW]], once: true },
  { name: 'imuMute', set: [['imu_mute_start', NOW], ['imu_mute', FOR_GOOD]] },
  { name: 'imuFrozen', set: [['imu_frozen_start', NOW], ['imu_frozen', FOR_GOOD]] },
  { name: 'imuGarbled', set: [['imu_garbled_start', NOW], ['imu_garbled', FOR_GOOD]] },
  { name: 'accBias', set: [['acc_bias', 2.3]] },
  { name: 'accSign', set: [['acc_sign', -1]] },
  { name: 'vibration', set: [['acc_alias', 3]] },
  { name: 'gust', set: [['gust_start', NOW], ['gust_length', 1], ['gust', 3]], once: true },
  { name: 'tugs', set: [['tug_rate', 0.4]] },
  { name: 'heavy', set: [['hover_thrust', 9]] },
  { name: 'edge', set: [['edge_start', NOW], ['edge_m', 0.3]] },
  { name: 'bars', set: [['bars_mm', 60]] },
];

const offered = signal(matchMedia('(min-width: 641px)').matches); // on a phone the plots come first
const opened = signal(false);
const refused = signal('');

function figureOf(vehicle: VehicleLink, name: string): Figure | undefined {
  return vehicle.figures.find((figure) => figure.name === name);
}

function begin(vehicle: VehicleLink, set: Setting[]): void {
  for (const [name, value] of set) vehicle.setFigure(name, value === NOW ? vehicle.truth().time_s : value);
}

function end(vehicle: VehicleLink, set: Setting[]): void {
  for (const [name] of [...set].reverse()) vehicle.setFigure(name, figureOf(vehicle, name)!.standard);
}

function isOn(vehicle: VehicleLink, set: Setting[]): boolean {
  return set.every(([name]) => {
    const figure = figureOf(vehicle, name);
    return figure !== undefined && (figure.value !== figure.standard || set.length > 1);
  }) && set.some(([name]) => figureOf(vehicle, name)!.value !== figureOf(vehicle, name)!.standard);
}

/** How far a slider goes: the limits where they mean something, else a few times what is usual in that unit. */
export function reach(figure: Figure): { low: number; high: number; step: number } {
  const usual: Record<string, number> = { 'm/s2': 6, mm: 400, s: 30, rad: 0.4, N: 12, deg: 60, 'deg/s': 400, Hz: 30, 'm/s': 3, m: 1.5, ppm: 2000 };
  const most = Math.max(usual[figure.unit] ?? 4, 3 * Math.abs(figure.standard) < FOR_GOOD ? 3 * Math.abs(figure.standard) : 0);
  const high = Math.min(figure.most, most);
  const low = Math.max(figure.least, figure.least < 0 && figure.least > -FOR_GOOD ? -high : 0);
  return { low, high, step: (high - low) / 200 };
}

const plain = (value: number): string => (value >= FOR_GOOD ? '∞' : shown(Number(value.toPrecision(5))));

function FigureRow({ vehicle, figure, changed }: { vehicle: VehicleLink; figure: Figure; changed: () => void }) {
  const words = w();
  const { low, high, step } = reach(figure);
  const [draft, setDraft] = useState<string | null>(null); // what is being typed
  const set = (value: number): void => {
    refused.value = vehicle.setFigure(figure.name, value) ? '' : `${figure.name}: ${plain(figure.least)} … ${plain(figure.most)}`;
    changed();
  };
  return (
    <li class={figure.value !== figure.standard ? 'changed' : ''}>
      <label><code>{figure.name}</code><input class="short" inputMode="decimal" value={draft ?? plain(figure.value)} onInput={(event) => setDraft(event.currentTarget.value)} onChange={(event) => {
        set(Number(typed(event.currentTarget.value).replace('∞', '1e9')));
        setDraft(null);
      }} /> {figure.unit === '-' ? '' : figure.unit}</label>
      <input type="range" aria-label={figure.name} min={low} max={high} step={step} value={figure.value} onInput={(event) => set(Number(event.currentTarget.value))} />
      <small lang="en">{figure.meaning}</small>
      {!figure.atOnce && <small class="tag">{words.fromPowerOn}</small>}
      {figure.value !== figure.standard && <button class="quiet" aria-label={`${words.standard}: ${figure.name}`} onClick={() => set(figure.standard)}>↺ {plain(figure.standard)}</button>}
    </li>
  );
}

/** Troubles on buttons, and below them every figure of the world. */
export function Troubles({ vehicle, changed }: { vehicle: VehicleLink; changed: () => void }) {
  const words = w();
  const known = TROUBLES.filter(({ set }) => set.every(([name]) => figureOf(vehicle, name)));
  const away = vehicle.figures.filter((figure) => figure.value !== figure.standard);
  return (
    <>
      <details class="figures" open={offered.value} onToggle={(event) => (offered.value = event.currentTarget.open)}>
      <summary>{words.troublesTitle}</summary>
      <div class="faults" role="group" aria-label={words.troublesTitle}>
        {known.map(({ name, set, once }) => {
          const on = !once && isOn(vehicle, set);
          return (
            <button key={name} class={on ? 'broken' : ''} aria-pressed={once ? undefined : on} onClick={() => {
              if (on) end(vehicle, set);
              else begin(vehicle, set);
              changed();
            }}>{words.troubles[name]}</button>
          );
        })}
      </div>
      </details>
      <details class="figures" open={opened.value} onToggle={(event) => (opened.value = event.currentTarget.open)}>
        <summary>{words.allFigures(vehicle.figures.length, away.length)}</summary>
        {refused.value && <p class="banner bad" role="alert">{words.objections.range} {refused.value}</p>}
        {away.length > 0 && <button class="quiet" onClick={() => { for (const { name, standard } of away) vehicle.setFigure(name, standard); changed(); }}>{words.allStandard}</button>}
        {opened.value && <ul>{vehicle.figures.map((figure) => <FigureRow key={figure.name} vehicle={vehicle} figure={figure} changed={changed} />)}</ul>}
      </details>
    </>
  );
}
