import { execFileSync } from 'node:child_process';
import { mkdtempSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { button, openBrowser, openGroups, openPage, parameter, PLOMADA, serveSite, startVehicle, tab, untilLaserIsOk, untilState, type Site } from './rig';
import { scripted, type Scripted } from './script';

let browser: Browser;
let site: Site;
let page: Page;
let vehicle: Scripted | null = null;

beforeAll(async () => {
  site = await serveSite();
  browser = await openBrowser();
});
afterAll(async () => {
  await browser?.close();
  site?.close();
});
afterEach(async () => {
  vehicle?.end();
  vehicle = null;
  await page?.context().close();
});

const shows = (text: string, timeout = 20_000): Promise<unknown> => page.waitForFunction((want) => document.body.innerText.includes(want), text, { timeout });
const text = (): Promise<string> => page.innerText('body');

async function openParameters(name = 'Parameters'): Promise<void> {
  await tab(page, name).click();
  await page.waitForSelector('.group', { timeout: 30_000 });
}

describe('the battery', () => {
  it('is judged by its cells, four on this vehicle, and their number is remembered', async () => {
    page = await openPage(browser, site.url);
    await startVehicle(page);
    await tab(page, 'Checks').click();
    const done = (): Promise<number> => page.locator('.checks li.done', { hasText: 'Battery' }).count();
    const volts = page.getByLabel('Battery', { exact: true });
    for (const [typed, good] of [['11.2', 0], ['14.7', 0], ['14.8', 1], ['14,8', 1], ['16.8', 1], ['17.2', 0], ['', 0], ['x', 0]] as const) {
      await volts.fill(typed);
      expect(await done(), typed).toBe(good);
    }
    expect(await text()).toContain('14.8 to 16.8 V');
    await page.getByLabel('Cells', { exact: true }).selectOption('3 cells');
    await volts.fill('11.2');
    expect(await done()).toBe(1);
    await volts.fill('14.8');
    expect(await text()).toContain('More than so many cells can have');
    await page.reload();
    await button(page, 'Close').click();
    await tab(page, 'Checks').click();
    expect(await text()).toContain('11.1 to 12.6 V');
  });
});

describe('a calibration', () => {
  it('that a stray key ended proposes nothing: the vehicle has not left the ground', async () => {
    page = await openPage(browser, site.url);
    await startVehicle(page, '5×');
    await untilLaserIsOk(page);
    await tab(page, 'Checks').click();
    await page.getByLabel('The vehicle is tied down').check();
    await button(page, 'Begin').click();
    await page.waitForFunction(() => parseFloat(document.querySelector('.alarm .big-value')?.textContent ?? '0') > 2.4, undefined, { timeout: 40_000 });
    await page.keyboard.press('x');
    await shows('Ended (a line came)');
    await page.waitForFunction(() => /GRAV \d\.\d+ is not proposed: the vehicle did not leave the ground \(it rose -?0\.0\d m\)/.test(document.body.innerText));
    expect(await page.getByRole('button', { name: /^Set GRAV/ }).count()).toBe(0);
  });

  for (const [how, risen, proposed] of [['that ended when the ropes were tight', 0.046, true], ['whose vehicle stands on its ropes', 0.011, false]] as const) {
    it(`${how} proposes ${proposed ? 'its thrust' : 'nothing'}, whatever the vehicle weighs`, async () => {
      let thrust = 0;
      let height = 0.004;
      vehicle = await scripted((line, say) => {
        if (line.startsWith('#GET LINK')) say('OK LINK 0');
        else if (line === '#HELP' || line === '#GET') say(`OK ${line.slice(1)} END lines:0`);
        else if (line.startsWith('#LINK')) say(`OK LINK ${line.slice(6)}`);
        else if (line.startsWith('#CALIBRATE')) { thrust = 1.93; say('OK CALIBRATE counts:30 seconds:5'); }
        else if (line.startsWith('#STOP')) {
          say('OK STOP');
          if (thrust > 0) say('OK CALIBRATE end:COMMAND thr:3.94 compare:3468 grav:3.94');
          thrust = 0;
        } else if (line.startsWith('#GRAV')) say(`OK GRAV ${line.slice(6)}`);
      });
      const timer = setInterval(() => vehicle?.say(`alt:${height.toFixed(3)} ref:0.000 laser:OK thr:${thrust.toFixed(2)} state:GROUND flags:0`), 200);
      page = await openPage(browser, site.url);
      await page.getByLabel('Address').fill(vehicle.url);
      await button(page, 'Connect').click();
      await tab(page, 'Checks').click();
      await page.getByLabel('The vehicle is tied down').check();
      await button(page, 'Begin').click();
      await page.waitForSelector('.alarm');
      await page.waitForTimeout(2000);
      height += risen;
      await page.waitForTimeout(2000);
      await page.keyboard.press('x');
      await shows('Ended (a line came)');
      if (proposed) {
        await button(page, 'Set GRAV 3.94').click();
        await expect.poll(() => vehicle!.heard.join(), { timeout: 3000 }).toContain('#GRAV 3.94');
      } else {
        await shows('GRAV 3.94 is not proposed');
      }
      clearInterval(timer);
    });
  }
});

describe('a take-off while the laser waits', () => {
  it('is said to wait, before the click and after it, and LAND takes it back', async () => {
    page = await openPage(browser, site.url);
    await startVehicle(page);
    await page.waitForFunction(() => document.querySelectorAll('.big-value')[3]?.textContent === 'WAIT');
    await button(page, 'Take off when the laser sees').click();
    await shows('Waits to take off to 0.60 m');
    expect(await text()).toContain('It takes off by itself as soon as the laser sees the ground.');
    expect(await text()).not.toContain('All is well');
    await page.keyboard.press('l');
    await page.waitForSelector('.land.answered');
    await page.waitForFunction(() => !document.body.innerText.includes('Waits to take off'));
    await button(page, '5×').click();
    await untilLaserIsOk(page);
    await page.waitForTimeout(2000);
    await untilState(page, 'GROUND', 1000);
    expect(await page.locator('.go').innerText()).toBe('Take off');
  });
});

describe('what is stored', () => {
  it('is never said of changes that are not written, nor of those that a file lacks', async () => {
    page = await openPage(browser, site.url);
    await startVehicle(page, '5×');
    await openParameters();
    expect(await page.getByRole('button', { name: 'Not stored (0)' }).count()).toBe(1); // its power-on was heard
    await (await parameter(page, 'KP')).fill('0.02');
    await button(page, 'Store on vehicle').click();
    await shows('Stored on the vehicle, but without 1 that are not written yet.');
    await button(page, 'Save to a file').click();
    await shows('The file has what the vehicle has, without 1 that are not written yet.');
    await page.getByRole('button', { name: 'Write changes (1)' }).click();
    await button(page, 'Write now').click();
    await shows('1 written.');
    await page.getByLabel('Search', { exact: true }).fill('');
    await page.getByRole('button', { name: 'Not stored (1)' }).click();
    expect(await page.locator('[data-parameter]').evaluateAll((rows) => rows.map((row) => (row as HTMLElement).dataset.parameter))).toEqual(['KP']);
    expect(await page.locator('[data-parameter] .tags').innerText()).toContain('not stored');
    await button(page, 'Store on vehicle').click();
    await shows('Stored on the vehicle.');
    await shows('Nothing is found.');
  });

  it('is not known of a vehicle that was on before, and the page says so', async () => {
    vehicle = await scripted((line, say) => {
      if (line === '#GET LINK') say('OK LINK 0');
      else if (line === '#HELP') for (const row of ['OK HELP #KP 0..1 N/mm - PD, PID: proportional gain.', 'OK HELP #ZETA 0..9 - - Of a newer firmware.', 'OK HELP END lines:2']) say(row);
      else if (line === '#GET') for (const row of ['OK KP 0.015', 'OK ZETA 3', 'OK GET END lines:2']) say(row);
    });
    const timer = setInterval(() => vehicle?.say('alt:0.004 ref:0.000 laser:OK thr:0.00 state:GROUND flags:0'), 200);
    page = await openPage(browser, site.url);
    await page.getByLabel('Address').fill(vehicle.url);
    await button(page, 'Connect').click();
    await openParameters();
    expect(await text()).toContain('What is stored is not known');
    expect(await page.getByRole('button', { name: 'Not stored (?)' }).isDisabled()).toBe(true);
    expect(await page.locator('[data-group=other] [data-parameter]').innerText()).toContain('ZETA'); // a parameter that this page does not know is not lost
    clearInterval(timer);
  });
});

describe('the parameters', () => {
  const rows = execFileSync(PLOMADA, ['params'], { encoding: 'utf8' }).trim().split('\n').map((row) => row.trim().split(/\s+/));
  const at = rows[0]!.indexOf('group');

  it('stand in the groups of the firmware’s table; those of other laws are closed', async () => {
    page = await openPage(browser, site.url);
    await startVehicle(page, '5×');
    await openParameters();
    expect(await page.locator('.group[data-group=pd-pid]').getAttribute('open')).toBeNull();
    expect(await page.locator('.group[data-group=pd-pid] summary').innerText()).toContain('law EST is set');
    expect(await page.locator('.group[data-group=est]').getAttribute('open')).not.toBeNull();
    await openGroups(page);
    const shown = await page.locator('[data-parameter]').evaluateAll((all) => all.map((row) => `${(row as HTMLElement).dataset.parameter} ${(row.closest('[data-group]') as HTMLElement).dataset.group}`));
    expect(shown.sort()).toEqual(rows.slice(1).map((cells) => `${cells[0]} ${cells[at]}`).sort());
    await page.locator('[data-parameter=LAW] select').selectOption('PID');
    expect(await page.locator('.group[data-group=pd-pid] summary').innerText()).not.toContain('is set');
  });

  it('are found by name and by meaning, in Spanish without accents too, and by what is not as delivered', async () => {
    page = await openPage(browser, site.url);
    await startVehicle(page, '5×');
    await openParameters();
    const found = (): Promise<(string | undefined)[]> => page.locator('[data-parameter]').evaluateAll((all) => all.map((row) => (row as HTMLElement).dataset.parameter));
    await page.getByLabel('Search', { exact: true }).fill('integral gain');
    expect(await found()).toEqual(['KI', 'PKI']);
    await page.getByLabel('Search', { exact: true }).fill('zzz');
    await shows('Nothing is found.');
    await (await parameter(page, 'PKI')).fill('1.5');
    await page.getByRole('button', { name: 'Write changes (1)' }).click();
    await button(page, 'Write now').click();
    await page.getByLabel('Search', { exact: true }).fill('');
    await page.getByRole('button', { name: 'Not as delivered (1)' }).click();
    expect(await found()).toEqual(['PKI']);
    await page.getByRole('button', { name: `All (${rows.length - 1})` }).click();
    await button(page, 'Español').click();
    await page.getByLabel('Buscar', { exact: true }).fill('angulo alabeo');
    expect(await found()).toEqual(['IROLL']);
  });

  for (const language of ['en-GB', 'es-ES']) {
    it(`have every limit in sight on a phone (${language})`, async () => {
      page = await openPage(browser, site.url, { width: 390, height: 844, locale: language });
      await page.locator('.featured button').click();
      await page.locator('.chip', { hasText: /^5×$/ }).click();
      await page.locator('nav button').nth(1).click();
      await openGroups(page);
      const cut = await page.locator('[data-parameter] > *').evaluateAll((all) => all.filter((cell) => {
        const range = document.createRange();
        range.selectNodeContents(cell);
        const box = range.getBoundingClientRect();
        return box.width > 0 && (box.left < 0 || box.right > 390 || (cell as HTMLElement).scrollWidth > (cell as HTMLElement).clientWidth + 1);
      }).map((cell) => `${cell.parentElement!.dataset.parameter} ${cell.className}`));
      expect(cut).toEqual([]);
      expect(await page.locator('[data-parameter=LF] .limits').innerText()).toBe('0 … 500 mm');
    });
  }
});

describe('in Spanish', () => {
  it('numbers have a comma wherever the page writes them, and both marks are understood', async () => {
    page = await openPage(browser, site.url, { locale: 'es-ES' });
    await page.locator('.featured button').click();
    await page.locator('.chip', { hasText: /^5×$/ }).click();
    await untilLaserIsOk(page);
    await page.locator('.go').click();
    await page.waitForFunction(() => Math.abs(parseFloat(document.querySelector('.big-value')!.textContent!.replace(',', '.')) - 0.6) < 0.06, undefined, { timeout: 30_000 });
    await page.locator('.figures summary').last().click();
    for (let view = 0; view < 5; view++) {
      await page.locator('nav button').nth(view).click();
      if (view === 1) await openGroups(page);
      const points = await page.evaluate(() => {
        const found: string[] = [];
        const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
        while (walker.nextNode()) if (!walker.currentNode.parentElement!.closest('[lang=en], code, script, pre, .lines')) found.push(walker.currentNode.textContent!);
        for (const element of document.querySelectorAll('input:not([type=range], .address input)')) found.push((element as HTMLInputElement).value);
        for (const element of document.querySelectorAll('[aria-label], [title], [placeholder]')) for (const name of ['aria-label', 'title', 'placeholder']) found.push(element.getAttribute(name) ?? '');
        return found.filter((one) => /\d\.\d/.test(one) && !/^(https?|ws):/.test(one) && !one.startsWith('#'));
      });
      expect(points, `view ${view}`).toEqual([]);
    }
    await page.locator('nav button').nth(1).click();
    await (await parameter(page, 'KP', 'Buscar')).fill('0,018');
    await page.getByRole('button', { name: /^Escribir cambios \(1\)/ }).click();
    await page.getByRole('button', { name: 'Escribir ahora' }).click();
    await shows('1 escritos.');
    expect(await page.getByLabel('KP', { exact: true }).inputValue()).toBe('0,018');
    await page.getByLabel('KP', { exact: true }).fill('2,9');
    await shows('Fuera de límites.');
    const file = join(mkdtempSync(join(tmpdir(), 'plomada-set-')), 'hand.set');
    writeFileSync(file, '#KP 0,03\r\n');
    const chooser = page.waitForEvent('filechooser');
    await page.getByRole('button', { name: 'Abrir un fichero' }).click();
    await (await chooser).setFiles([file]);
    await page.waitForFunction(() => (document.querySelector('[aria-label=KP]') as HTMLInputElement).value === '0,03');
    await page.locator('nav button').nth(4).click();
    expect(await page.locator('.lines').innerText()).toContain('#KP 0.018');
    await page.locator('nav button').nth(3).click();
    await page.getByLabel('Batería', { exact: true }).fill('14,9');
    expect(await page.locator('.checks li.done', { hasText: 'Batería' }).count()).toBe(1);
  });
});
