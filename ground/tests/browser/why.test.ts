import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { button, openBrowser, openPage, PLOMADA, ROOT, serveSite, tab, type Site } from './rig';

let browser: Browser;
let site: Site;
let page: Page;
const home = mkdtempSync(join(tmpdir(), 'plomada-why-'));

beforeAll(async () => {
  mkdirSync(join(home, 'Downloads'));
  site = await serveSite();
  browser = await openBrowser();
});
afterAll(async () => {
  await browser?.close();
  site?.close();
});
afterEach(async () => {
  await page?.context().close();
});

async function replay(file: string): Promise<void> {
  page = await openPage(browser, site.url);
  await button(page, 'Close').click();
  await tab(page, 'Replay').click();
  const chooser = page.waitForEvent('filechooser');
  await button(page, 'Open a file').click();
  await (await chooser).setFiles(file);
  await page.waitForSelector('.why', { timeout: 20_000 });
}

describe('the question why', () => {
  it('saves the log as it was read, and the line that it shows answers', async () => {
    const flown = join(home, 'flown.log'); // a console with a dump, as an operator saves it
    execFileSync(PLOMADA, ['fly', 'est-60cm-ramp', '--set', 'LAYOUT=FRONT', '--log', flown], { stdio: 'ignore' });
    await replay(flown);
    const download = page.waitForEvent('download');
    await button(page, 'Why did it do that?').click();
    const saved = await download;
    await saved.saveAs(join(home, 'Downloads', saved.suggestedFilename()));
    const csv = readFileSync(join(home, 'Downloads', saved.suggestedFilename()), 'utf8');
    execFileSync(PLOMADA, ['log', flown, '-o', home], { stdio: 'ignore' });
    expect(csv).toBe(readFileSync(join(home, 'flown.csv'), 'utf8'));
    const shown = await page.locator('.why .command').innerText();
    expect(shown).toBe(`make why LOG="$HOME/Downloads/${saved.suggestedFilename()}"`);
    // What `make why` does once all is installed and built, in the same shell's words.
    const line = /^\t@(build\/plomada why .*)$/m.exec(readFileSync(join(ROOT, 'Makefile'), 'utf8'))![1]!.replace('$(LOG)', /LOG="(.*)"$/.exec(shown)![1]!).replace('$(ARGS)', `--out ${home}/why.png`);
    const answer = execFileSync('bash', ['-c', line], { cwd: ROOT, env: { ...process.env, HOME: home }, encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] });
    expect(answer.split('\n')[0]).toMatch(/^The heights jump .* edges, or colours of the floor\.$/); // the ramp and the edge of that course
  }, 120_000);

  it('says of telemetry, and of a log without accelerations, that they do not tell why', async () => {
    const seen = join(home, 'seen.txt');
    writeFileSync(seen, 'alt:0.598 ref:0.600 laser:OK thr:7.12 state:FLYING flags:0\r\n'.repeat(50));
    await replay(seen);
    expect(await button(page, 'Why did it do that?').isDisabled()).toBe(true);
    expect(await page.locator('.why').innerText()).toContain('do not tell why. Type #LOG RATE FAST before the flight');
  });
});
