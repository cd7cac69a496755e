import { execFileSync } from 'node:child_process';

/** What the page is told of the firmware that it is built with: `define` of vite. */
export function firmware(): Record<string, string> {
  const lines = execFileSync('../build/plomada', ['params'], { encoding: 'utf8' }).trim().split('\n').map((line) => line.trim().split(/\s+/));
  const column = (title: string): string => JSON.stringify(Object.fromEntries(lines.slice(1).map((cells) => [cells[0]!, cells[lines[0]!.indexOf(title)]!])));
  return { __DELIVERED__: column('default'), __GROUPS__: column('group') };
}
