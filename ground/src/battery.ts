/** Of the vehicle of docs/hardware.md: 4S, 14.8 to 16.8 V. */
export const CELLS = 4;
export const CELLS_MOST = 6;
const NOMINAL_V = 3.7; // lithium polymer: 14.8 V are four of them
const FULL_V = 4.2; // 16.8 V
const CHARGER_V = 0.05; // a charger ends within so much of full

export function batteryLimits(cells: number): { least: number; most: number } {
  return { least: cells * NOMINAL_V, most: cells * FULL_V };
}

/** `many`: no battery of so many cells has this; they were counted wrong. */
export function battery(cells: number, volts: number): 'none' | 'low' | 'many' | 'good' {
  if (!(volts > 0)) return 'none';
  const { least, most } = batteryLimits(cells);
  const within = 1e-6; // of binary fractions
  if (volts < least - within) return 'low';
  return volts > most + cells * CHARGER_V + within ? 'many' : 'good';
}
