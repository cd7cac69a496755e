import { execFileSync } from 'node:child_process';

/** What the page is told of the firmware that it is built with: `define` of vite. */
export function firmware(): Record<string, string> {
  const rows = execFileSync('../build/plomada', ['params'], { encoding: 'utf8' }).trim().split('\n').slice(1);
  return { __DELIVERED__: JSON.stringify(Object.fromEntries(rows.map((row) => row.trim().split(/\s+/)).map((cells) => [cells[0]!, cells[4]!]))) };
}
