import { OpenError, type Link, type LinkEvents } from './link';
import { Wasi } from './wasi';

/** sim/wasm/vehicle.h, the names that the module exports. */
interface Exports {
  memory: WebAssembly.Memory;
  _initialize(): void;
  vehicle_room(): number;
  vehicle_fly(size: number): number;
  vehicle_power_on(seed: number): void;
  vehicle_blank_storage(): void;
  vehicle_step(milliseconds: number): number;
  vehicle_type(size: number): void;
  vehicle_heard(): number;
  vehicle_truth(): number;
  vehicle_power_laser(on: number): void;
  vehicle_power_imu(on: number): void;
  vehicle_trouble_laser(code: number): void;
  vehicle_select(firmware: number): void;
  vehicle_lay(size: number): number;
  vehicle_go(): void;
  vehicle_map(): number;
  vehicle_view(): number;
  vehicle_reach(inReach: number): void;
  vehicle_plant(): number;
  vehicle_set(size: number): number;
}

export interface Truth {
  time_s: number;
  height_m: number;
  altitude_m: number;
  terrain_m: number;
  speed_mps: number;
  thrust_n: number;
  roll_rad: number;
  pitch_rad: number;
  pulse_us: number;
  contacts: number;
}
const TRUTH = ['time_s', 'height_m', 'altitude_m', 'terrain_m', 'speed_mps', 'thrust_n', 'roll_rad', 'pitch_rad', 'pulse_us', 'contacts'] as const;

type Point = [x: number, y: number, z: number];

export interface Beam {
  from: Point;
  to: Point;
  meets: boolean; // else nothing in the sensor's reach
}

/** Where the vehicle is, the ground along its nose, and its beams: front, aft, fore (sim/devices/view.h). */
export interface View {
  x: number;
  y: number;
  heading: number;
  ground: number[]; // every GROUND_STEP metres from GROUND_FIRST on
  beams: Beam[];
}
export const GROUND_FIRST = -2;
export const GROUND_STEP = 0.025;
const GROUND_POINTS = 161;
const BEAMS = 3;
const BEAM_VALUES = 7;

/** A thing in the place, as it is now. */
export interface Block {
  x: number;
  y: number;
  heading: number;
  length: number;
  width: number;
  top: number;
}

export type PlaceName = 'floor' | 'hall' | 'own';

export interface PlaceMap {
  blocks: Block[];
  way: [x: number, y: number][];
}

/** A figure of the simulated world (`plomada list --plant`). */
export interface Figure {
  name: string;
  unit: string;
  least: number;
  most: number;
  standard: number;
  value: number;
  atOnce: boolean; // else from the next power-on
  meaning: string;
}

let compiled: Promise<WebAssembly.Module> | null = null;

/** vehicle.js stands beside the page and holds plomada.wasm as text, because a page that was opened from a disk may fetch
 * nothing else. */
function loadModule(): Promise<WebAssembly.Module> {
  compiled ??= new Promise((resolve, reject) => {
    const script = document.createElement('script');
    script.src = 'vehicle.js';
    script.onerror = () => reject(new OpenError('noVehicle'));
    script.onload = () => {
      const text = (window as unknown as { plomadaVehicle?: string }).plomadaVehicle ?? '';
      const octets = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
      WebAssembly.compile(octets).then(resolve, (error: Error) => reject(new OpenError('noVehicle', error.message)));
    };
    document.head.append(script);
  });
  compiled.catch(() => (compiled = null));
  return compiled;
}

async function instantiate(module: WebAssembly.Module): Promise<{ exports: Exports; wasi: Wasi }> {
  const wasi = new Wasi();
  const instance = await WebAssembly.instantiate(module, { wasi_snapshot_preview1: wasi.imports() });
  const exports = instance.exports as unknown as Exports;
  wasi.memory = exports.memory;
  exports._initialize();
  return { exports, wasi };
}

/** `plomada fly` in the page: what it printed, and the files it wrote. */
export async function flyScenario(args: string[]): Promise<{ status: number; output: string; files: Map<string, string> }> {
  const { exports, wasi } = await instantiate(await loadModule());
  const octets = new TextEncoder().encode(args.map((arg) => `${arg}\0`).join(''));
  new Uint8Array(exports.memory.buffer).set(octets, exports.vehicle_room());
  const status = exports.vehicle_fly(octets.length);
  const files = new Map([...wasi.files].map(([name, file]) => [name, new TextDecoder().decode(file)]));
  return { status, output: wasi.output, files };
}

const ROOM = 65536; // VEHICLE_ROOM of sim/wasm/vehicle.h
const TICK = 20; // ms of the wall clock between two steps
const CATCH_UP = 1500; // a page in the background is woken once a second

export async function openVehicle(events: LinkEvents, seed: number): Promise<VehicleLink> {
  const { exports } = await instantiate(await loadModule());
  return new VehicleLink(exports, events, seed);
}

export class VehicleLink implements Link {
  readonly kind = 'vehicle';
  readonly label = 'simulated vehicle';
  speed = 1;
  radio = true;
  laser = true;
  imu = true;
  pilot = false;
  place: PlaceName = 'floor';
  readonly figures: Figure[];
  private readonly room: number;
  private readonly origin = Date.now();
  private elapsed = 0;
  private owed = 0;
  private wall = performance.now();
  private timer: ReturnType<typeof setInterval>;

  constructor(
    private readonly machine: Exports,
    private readonly events: LinkEvents,
    private seed: number,
  ) {
    this.room = machine.vehicle_room();
    machine.vehicle_power_on(seed);
    this.figures = this.readFigures();
    this.timer = setInterval(() => this.tick(), TICK);
  }

  now(): number {
    return this.origin + this.elapsed;
  }

  send(text: string): void {
    const octets = new TextEncoder().encode(`${text}\n`);
    new Uint8Array(this.machine.memory.buffer).set(octets, this.room);
    this.machine.vehicle_type(octets.length);
  }

  async close(): Promise<void> {
    clearInterval(this.timer);
  }

  truth(): Truth {
    const values = new Float64Array(this.machine.memory.buffer, this.machine.vehicle_truth(), TRUTH.length);
    return Object.fromEntries(TRUTH.map((name, i) => [name, values[i]])) as unknown as Truth;
  }

  powerCycle(): void {
    this.laser = this.imu = this.radio = true;
    this.pilot = false;
    this.machine.vehicle_power_on(++this.seed);
  }

  setLaser(on: boolean): void {
    this.laser = on;
    this.machine.vehicle_power_laser(on ? 1 : 0);
  }

  setImu(on: boolean): void {
    this.imu = on;
    this.machine.vehicle_power_imu(on ? 1 : 0);
  }

  setRadio(on: boolean): void {
    this.radio = on;
    this.machine.vehicle_reach(on ? 1 : 0);
  }

  /** From the module's own list, whatever it has. */
  private readFigures(): Figure[] {
    return this.heard(this.machine.vehicle_plant()).trim().split('\n').map((row) => {
      const [name = '', unit = '', least, most, value, atOnce, meaning = ''] = row.split('\t');
      return { name, unit, least: Number(least), most: Number(most), standard: Number(value), value: Number(value), atOnce: atOnce === '1', meaning };
    });
  }

  /** false: no such figure, or out of its limits. */
  setFigure(name: string, value: number): boolean {
    const figure = this.figures.find((one) => one.name === name);
    const octets = new TextEncoder().encode(`${name}=${value}`);
    if (!figure || !Number.isFinite(value)) return false;
    new Uint8Array(this.machine.memory.buffer).set(octets, this.room);
    if (this.machine.vehicle_set(octets.length) === 0) return false;
    figure.value = value;
    return true;
  }

  setPilot(on: boolean): void {
    this.pilot = on;
    this.machine.vehicle_select(on ? 0 : 1);
  }

  troubleLaser(): void {
    this.machine.vehicle_trouble_laser(70);
  }

  /** The way of the place, or the seed's ramp. */
  go(): void {
    this.machine.vehicle_go();
  }

  /** The place of the next power-on, by the text of a place file; '': an even floor. What is wrong with it; '': nothing. */
  lay(place: PlaceName, text: string): string {
    const octets = new TextEncoder().encode(text).slice(0, ROOM - 1); // the module says what is too long
    new Uint8Array(this.machine.memory.buffer).set(octets, this.room);
    const wrong = this.heard(this.machine.vehicle_lay(octets.length));
    if (wrong === '') this.place = place;
    return wrong;
  }

  map(): PlaceMap {
    const map: PlaceMap = { blocks: [], way: [] };
    for (const line of this.heard(this.machine.vehicle_map()).split('\n')) {
      const [kind, ...rest] = line.split(' ');
      const [x = 0, y = 0, heading = 0, length = 0, width = 0, , near = 0, far = 0] = rest.map(Number);
      if (kind === 'block') map.blocks.push({ x, y, heading, length, width, top: Math.max(near, far) });
      if (kind === 'leg') map.way.push([x, y]);
    }
    return map;
  }

  view(): View {
    const values = Array.from(new Float64Array(this.machine.memory.buffer, this.machine.vehicle_view(), 3 + GROUND_POINTS + BEAMS * BEAM_VALUES));
    const [x = 0, y = 0, heading = 0] = values;
    const beams = Array.from({ length: BEAMS }, (_, i): Beam => {
      const [fromX = 0, fromY = 0, fromZ = 0, toX = 0, toY = 0, toZ = 0, meets] = values.slice(3 + GROUND_POINTS + i * BEAM_VALUES);
      return { from: [fromX, fromY, fromZ], to: [toX, toY, toZ], meets: meets === 1 };
    });
    return { x, y, heading, ground: values.slice(3, 3 + GROUND_POINTS), beams };
  }

  private heard(size: number): string {
    return new TextDecoder().decode(new Uint8Array(this.machine.memory.buffer, this.room, size));
  }

  /** false: the program has stopped for good, or broken. */
  private step(milliseconds: number): boolean {
    try {
      return this.machine.vehicle_step(milliseconds) !== 0;
    } catch (error) {
      console.error(error);
      return false;
    }
  }

  /** Lets the time pass that the wall clock says, in small steps, so that answers come at their time. */
  private tick(): void {
    const wall = performance.now();
    this.owed += Math.min(wall - this.wall, CATCH_UP) * this.speed;
    this.wall = wall;
    while (this.owed >= 10) {
      const step = Math.min(Math.floor(this.owed), 50);
      this.owed -= step;
      this.elapsed += step;
      if (!this.step(step)) {
        clearInterval(this.timer);
        this.events.lost('halted');
        return;
      }
      const count = this.machine.vehicle_heard();
      if (count > 0) this.events.octets(new Uint8Array(this.machine.memory.buffer, this.room, count).slice());
    }
  }
}
