// The first minute of docs/ground.md, as it stands there: what it says to press is pressed, what it says to see is waited for.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import type { Browser } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { button, openBrowser, openPage, ROOT, untilHeight } from './rig';

const page = readFileSync(join(ROOT, 'docs/ground.md'), 'utf8');
const steps = /## Your first minute\n\n((?:.*\n)*?)\n\*\*Why/.exec(page)![1]!.replace(/\s+/g, ' ');
const named = [...steps.matchAll(/([Pp]ress )?(?<!\*)\*([^*]+)\*/g)].map(([, press, name]) => ({ press: press !== undefined, name: name! }));

describe('the first minute of the page on Plomada Ground', () => {
  let browser: Browser;
  beforeAll(async () => { browser = await openBrowser(); });
  afterAll(() => browser.close());

  it('flies, breaks the laser, and lands as it says, from a file on the disk', async () => {
    expect(named.filter(({ press }) => press).map(({ name }) => name)).toEqual(['Start the simulated vehicle', 'Take off', 'Unplug laser', 'Plug laser in']);
    const opened = await openPage(browser, pathToFileURL(join(ROOT, 'build-ground/index.html')).href);
    for (const { press, name } of named) {
      if (name === 'Unplug laser') await untilHeight(opened, 0.6, 0.05);
      if (name === 'Plug laser in') await opened.getByText('On the ground, no thrust').first().waitFor();
      if (press) await button(opened, name).click();
      else await opened.getByText(name).first().waitFor({ timeout: 30_000 });
    }
    expect(await opened.locator('.big-value').nth(2).textContent()).toBe('GROUND'); // it stays there
  }, 90_000);
});
