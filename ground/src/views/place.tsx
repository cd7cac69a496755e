import hall from '../../../docs/examples/hall.place?raw';
import { GROUND_FIRST, GROUND_STEP, type Beam, type PlaceName, type VehicleLink, type View } from '../link/vehicle';
import { clock, ofThisVehicle, powerCycle } from '../store';
import { shown, w } from '../words';

const wrong = ofThisVehicle(''); // with the file that was chosen

const WIDE = 260;
const degrees = (radians: number): number => (radians * 180) / Math.PI;
const colour = (top: number): string => `color-mix(in srgb, var(--curve-truth) ${Math.round(20 + 60 * Math.min(Math.max(top, 0) / 1.5, 1))}%, var(--surface))`;

/** From the vehicle's right side: the ground along its nose, the vehicle, and its three beams. */
function FromTheSide({ vehicle, view }: { vehicle: VehicleLink; view: View }) {
  const truth = vehicle.truth();
  const scale = 70; // pixels per metre
  const zero = 150;
  const middle = 145;
  const x = (ahead: number): number => middle + ahead * scale;
  const y = (height: number): number => zero - height * scale;
  const ahead = ([px, py]: Beam['to']): number => (px - view.x) * Math.cos(view.heading) + (py - view.y) * Math.sin(view.heading);
  const body = y(truth.altitude_m) - 12;
  const points = view.ground.map((height, i) => `${x(GROUND_FIRST + i * GROUND_STEP).toFixed(1)},${y(height).toFixed(1)}`);
  return (
    <svg class="picture" viewBox={`0 ${Math.min(0, body - 30)} ${WIDE} 170`} role="img" aria-label={`${w().fromTheSide}. ${w().truth} ${shown(truth.height_m, 2)} m`}>
      <g class="grid-lines">{[0, 0.5, 1, 1.5, 2, 2.5, 3].map((m) => (<g key={m}><line x1="34" x2={WIDE - 4} y1={y(m)} y2={y(m)} /><text x="4" y={y(m) + 4}>{shown(m)} m</text></g>))}</g>
      <polygon class="earth" points={`${x(GROUND_FIRST)},400 ${points.join(' ')} ${x(-GROUND_FIRST)},400`} />
      {vehicle.laser && view.beams.map((beam, i) => (<line key={i} class="beam" data-meets={beam.meets} data-height={beam.to[2].toFixed(3)} x1={x(ahead(beam.from))} y1={y(beam.from[2])} x2={x(ahead(beam.to))} y2={y(beam.to[2])} />))}
      <g transform={`translate(${middle} ${body}) rotate(${-degrees(truth.pitch_rad)})`}>
        <rect class="body" x="-16" y="-9" width="32" height="12" rx="4" />
        <path class="arm" d="M-46 -8H46M-20 3l-6 9M20 3l6 9" />
        {[-46, 46].map((arm) => (<g key={arm}><line class="arm" x1={arm} x2={arm} y1="-8" y2="-14" /><ellipse class={truth.thrust_n > 0.5 ? 'rotor spin' : 'rotor'} cx={arm} cy="-15" rx="20" ry="2.6" /></g>))}
      </g>
      <text x={WIDE - 4} y="164" text-anchor="end">{w().fromTheSide}</text>
    </svg>
  );
}

/** From above: what stands around, darker where it is higher, the way, and where the beams end. */
function FromAbove({ vehicle, view }: { vehicle: VehicleLink; view: View }) {
  const map = vehicle.map();
  const scale = 32;
  const high = 130;
  const x = (px: number): number => WIDE / 2 + (px - view.x) * scale;
  const y = (py: number): number => high / 2 - (py - view.y) * scale;
  const way = [[view.x, view.y] as const, ...map.way];
  return (
    <svg class="picture above" viewBox={`0 0 ${WIDE} ${high}`} role="img" aria-label={`${w().fromAbove}. x ${shown(view.x, 1)} m, y ${shown(view.y, 1)} m`}>
      {[...map.blocks].sort((a, b) => a.top - b.top).map((block, i) => (
        <rect key={i} class="block" style={{ fill: colour(block.top) }} transform={`translate(${x(block.x)} ${y(block.y)}) rotate(${-degrees(block.heading)})`}
          x={(-block.length * scale) / 2} y={(-block.width * scale) / 2} width={block.length * scale} height={block.width * scale} />
      ))}
      {map.way.length > 0 && <polyline class="way" points={way.map(([px, py]) => `${x(px).toFixed(1)},${y(py).toFixed(1)}`).join(' ')} />}
      <g transform={`translate(${WIDE / 2} ${high / 2}) rotate(${-degrees(view.heading)})`}>
        <path class="arm" d="M-8 -8L8 8M-8 8L8 -8" /><path class="body" d="M4 -4L13 0L4 4z" />
      </g>
      {vehicle.laser && view.beams.map((beam, i) => (<circle key={i} class="spot" cx={x(beam.to[0])} cy={y(beam.to[1])} r="2.2" />))}
      <g class="grid-lines"><line x1="8" x2={8 + scale} y1={high - 8} y2={high - 8} /><text x="8" y={high - 12}>1 m</text></g>
      <text x={WIDE - 4} y={high - 6} text-anchor="end">{w().fromAbove}</text>
    </svg>
  );
}

export function Picture({ vehicle }: { vehicle: VehicleLink }) {
  void clock.value;
  const view = vehicle.view();
  return (<div class="pictures"><FromTheSide vehicle={vehicle} view={view} /><FromAbove vehicle={vehicle} view={view} /></div>);
}

/** Where it flies: an even floor, the hall of the examples, or a place file of one's own. It is switched off and on there. */
export function Places({ vehicle, changed }: { vehicle: VehicleLink; changed: () => void }) {
  const words = w();
  const lay = (place: PlaceName, text: string): void => {
    const objection = vehicle.lay(place, text);
    if (objection === '') powerCycle();
    wrong.value = objection;
    changed();
  };
  const style = (place: PlaceName): string => `chip ${vehicle.place === place ? 'chosen' : ''}`;
  return (
    <div class="places" role="group" aria-label={words.place}>
      <span class="row-label">{words.place}</span>
      <button class={style('floor')} aria-pressed={vehicle.place === 'floor'} onClick={() => lay('floor', '')}>{words.evenFloor}</button>
      <button class={style('hall')} aria-pressed={vehicle.place === 'hall'} onClick={() => lay('hall', hall)}>{words.hall}</button>
      <label class={`file ${style('own')}`}>{words.ownPlace}<input type="file" onChange={(event) => {
        const [file] = event.currentTarget.files ?? [];
        event.currentTarget.value = ''; // the same file may be chosen again, mended
        void file?.text().then((text) => lay('own', text));
      }} /></label>
      {wrong.value && <p class="banner bad" role="alert">{wrong.value}</p>}
    </div>
  );
}
