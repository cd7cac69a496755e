import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { button, openBrowser, openGroups, openPage, parameter, picture, PLOMADA, serveSite, startVehicle, tab, untilHeight, untilLaserIsOk, untilState, type Site } from './rig';
import { scripted } from './script';

let browser: Browser;
let site: Site;
let page: Page;

beforeAll(async () => {
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

const shows = (text: string, timeout = 20_000): Promise<unknown> => page.waitForFunction((want) => document.body.innerText.includes(want), text, { timeout });

async function airborne(speed: string): Promise<void> {
  page = await openPage(browser, site.url);
  await startVehicle(page, speed);
  await untilLaserIsOk(page);
  await button(page, 'Take off').click();
  await untilHeight(page, 0.6, 0.06);
}

async function saved(name: string): Promise<Buffer> {
  const download = page.waitForEvent('download');
  await button(page, name).click();
  return readFileSync(await (await download).path());
}

async function openFiles(name: string, ...paths: string[]): Promise<void> {
  const chooser = page.waitForEvent('filechooser');
  await button(page, name).click();
  await (await chooser).setFiles(paths);
}

describe('a vehicle that demands sums', () => {
  it('gets one on every line, STOP and LAND too, once #SUM is ON, and the page finds that out by itself', async () => {
    page = await openPage(browser, site.url);
    await startVehicle(page, '5×');
    await tab(page, 'Parameters').click();
    await (await parameter(page, 'SUM')).selectOption('ON');
    await page.getByRole('button', { name: 'Write changes (1)' }).click();
    await button(page, 'Write now').click();
    await shows('1 written.');
    await tab(page, 'Console').click();
    expect(await page.getByLabel('A sum on every line').isChecked()).toBe(true);
    await page.getByLabel('A sum on every line').uncheck(); // as a page that does not know it yet
    await tab(page, 'Fly').click();
    await untilLaserIsOk(page);
    await button(page, 'Take off').click();
    await untilHeight(page, 0.6, 0.06);
    await page.keyboard.press('l');
    await page.waitForSelector('.land.answered');
    await page.keyboard.press('Escape');
    await page.waitForSelector('.stop.answered');
    await tab(page, 'Recorder').click();
    await button(page, 'Last 20 s').click();
    await page.waitForFunction(() => /\d+ rows, none missing/.test(document.body.innerText), undefined, { timeout: 50_000 });
    await tab(page, 'Console').click();
    const lines = await page.locator('.lines .out code').allInnerTexts();
    const told = lines.slice(lines.indexOf('#SETR 0.6') + 1); // refused, and sent again with its sum
    for (const want of ['#SETR 0.6', '#LAND', '#STOP', '#LOG 20']) expect(told.filter((line) => line.startsWith(`${want}*`)).length, want).toBeGreaterThan(0);
    expect(told.filter((line) => !/^#.*\*[0-9A-F]{4}$/.test(line))).toEqual([]);
    expect(await page.locator('.lines .err code').allInnerTexts()).toEqual(['ERR - sum missing, see #SUM']);
  });
});

describe('troubles of the simulated world', () => {
  it('come at a click in flight, and go: what lasts is undone, what does not ends by itself', async () => {
    await airborne('2×');
    await button(page, 'IMU mute').click();
    await shows('No fresh attitude');
    await button(page, 'IMU mute').click();
    await shows('All is well');
    await button(page, 'Sight blocked').click();
    await shows('Heights in doubt');
    await picture(page, 'troubles');
    await button(page, 'Sight blocked').click();
    await button(page, 'Laser restarts').click();
    await page.waitForFunction(() => document.querySelectorAll('.big-value')[3]?.textContent !== 'OK');
    await untilLaserIsOk(page);
  });

  it('are all there, each figure of the program has its slider, and what is out of limits is refused', async () => {
    page = await openPage(browser, site.url);
    await startVehicle(page, '5×');
    const list = execFileSync(PLOMADA, ['list', '--plant'], { encoding: 'utf8' });
    const names = [...list.matchAll(/^ {2}plant\.(\S+)/gm)].map((match) => match[1]!);
    expect(names.length).toBeGreaterThan(50);
    await page.getByText(`All ${names.length} figures of the simulated world`).click();
    expect(await page.locator('.figures li code').allInnerTexts()).toEqual(names);
    expect(await page.locator('.faults').nth(1).getByRole('button').count()).toBe(17);
    const share = page.getByRole('textbox', { name: 'rays_lost', exact: true });
    await share.fill('1.5');
    await share.blur();
    await shows('Out of limits. rays_lost: 0 … 1');
    await page.getByRole('slider', { name: 'rays_lost', exact: true }).fill('0.6');
    await shows(`${names.length} figures of the simulated world, 1 changed`);
    expect(await button(page, '60 % of rays lost').getAttribute('aria-pressed')).toBe('true');
    await button(page, 'All as they were').click();
    expect(await button(page, '60 % of rays lost').getAttribute('aria-pressed')).toBe('false');
  });
});

describe('a reference that the firmware refuses', () => {
  it('is answered where it was given, with the reason', async () => {
    page = await openPage(browser, site.url);
    await startVehicle(page, '5×');
    await untilLaserIsOk(page);
    await tab(page, 'Console').click();
    await page.locator('#command').fill('#IROLL PITCH');
    await page.keyboard.press('Enter');
    await page.waitForFunction(() => document.querySelector('.lines')!.textContent!.includes('OK IROLL PITCH'));
    await tab(page, 'Fly').click();
    await button(page, 'Take off').click();
    await page.waitForSelector('.reference [role=alert]');
    expect(await page.locator('.reference [role=alert]').innerText()).toMatch(/^Refused: /);
  });
});

describe('the plots', () => {
  it('are held, zoomed and let go, and saved as CSV and PNG', async () => {
    await airborne('5×');
    const drawn = (): Promise<string> => page.evaluate(() => document.querySelector('canvas')!.toDataURL());
    const moves = async (): Promise<boolean> => {
      const before = await drawn();
      await page.waitForTimeout(700);
      return (await drawn()) !== before;
    };
    expect(await moves()).toBe(true);
    await button(page, 'Hold').click();
    await page.waitForTimeout(200);
    expect(await moves()).toBe(false);
    await button(page, 'Hold').click();
    expect(await moves()).toBe(true);
    const box = (await page.locator('.u-over').first().boundingBox())!;
    await page.mouse.move(box.x + 200, box.y + 60);
    await page.mouse.down();
    await page.mouse.move(box.x + 400, box.y + 60, { steps: 5 });
    await page.mouse.up();
    await page.waitForTimeout(300);
    expect(await moves()).toBe(false);
    await page.mouse.dblclick(box.x + 300, box.y + 60);
    expect(await moves()).toBe(true);
    const csv = (await saved('Save CSV')).toString().trim().split('\n');
    expect(csv[0]).toBe('t_s,meas_m,ref_m,thrust_n,state,flags');
    expect(csv.length).toBeGreaterThan(50);
    expect(csv[csv.length - 1]).toMatch(/^\d+\.\d{3},0\.\d{3},0\.600,\d+\.\d\d,FLYING,0$/);
    const png = await saved('Save picture');
    expect(png.subarray(1, 4).toString()).toBe('PNG');
    const heights = await page.evaluate(() => [...document.querySelectorAll('canvas')].map((canvas) => canvas.height));
    expect(png.readUInt32BE(20)).toBe(heights.reduce((sum, one) => sum + one, 0));
  });
});

describe('the wizards', () => {
  it('find the IMU level, say in words why a tilt was not understood, and show what it sends', async () => {
    page = await openPage(browser, site.url);
    await startVehicle(page, '5×');
    await tab(page, 'Checks').click();
    await button(page, '1 Level').click();
    await shows('OK IMU LEVEL IUNIT:256.00 IDOWN:Z');
    await button(page, '2 Right side up').click();
    await shows('tilt by 8..60 deg about one axis');
    await button(page, 'What does it say?').click();
    await shows('seen:accelerations+angles');
  });

  it('prove the signs of an IMU that is tilted by hand, right side first, then the nose', async () => {
    page = await openPage(browser, site.url);
    await startVehicle(page, '5×');
    const tilt = async (figure: string, degrees: number): Promise<void> => {
      await tab(page, 'Fly').click();
      await page.locator('details.figures').last().evaluate((all: HTMLDetailsElement) => (all.open = true));
      await page.getByRole('slider', { name: figure, exact: true }).fill(String(degrees));
      await tab(page, 'Checks').click();
    };
    await tab(page, 'Checks').click();
    await button(page, '1 Level').click();
    await shows('OK IMU LEVEL');
    await tilt('imu_mount_roll_deg', 15);
    await page.waitForTimeout(1500);
    await button(page, '2 Right side up').click();
    await shows('OK IMU RIGHT IROLL:-ROLL IAXES:ASSUMED');
    await tilt('imu_mount_roll_deg', 0);
    await tilt('imu_mount_pitch_deg', 15);
    await page.waitForTimeout(1500);
    await button(page, '3 Nose up').click();
    await shows('OK IMU NOSE IPITCH:PITCH IAXES:PROVED');
  });

  it('end a calibration when the window loses the focus, and LINK is then what it was', async () => {
    page = await openPage(browser, site.url);
    await startVehicle(page, '5×');
    await tab(page, 'Fly').click();
    await untilLaserIsOk(page);
    await tab(page, 'Checks').click();
    await page.getByLabel('The vehicle is tied down').check();
    await button(page, 'Begin').click();
    await page.waitForFunction(() => parseFloat(document.querySelector('.alarm .big-value')?.textContent ?? '0') > 0.3, undefined, { timeout: 40_000 });
    await page.evaluate(() => window.dispatchEvent(new Event('blur')));
    await shows('Ended (a line came)');
    await tab(page, 'Console').click();
    await page.waitForFunction(() => document.querySelector('.lines')!.textContent!.includes('OK LINK 0'));
  });
});

describe('what was saved', () => {
  it('opens again, whatever `plomada log` reads: CSV, console text, XCTU’s log, a session', async () => {
    await airborne('5×');
    await page.keyboard.press('l');
    await untilState(page, 'GROUND');
    await tab(page, 'Console').click();
    await page.locator('#command').fill('#LOG 5');
    await page.keyboard.press('Enter');
    await page.waitForFunction(() => document.querySelector('.lines')!.textContent!.includes('OK LOG END'), undefined, { timeout: 40_000 });
    await page.getByRole('button', { name: '↻' }).click();
    const session = (await (async () => {
      const download = page.waitForEvent('download');
      await page.locator('.sessions').getByRole('button', { name: 'Save', exact: true }).first().click();
      return readFileSync(await (await download).path(), 'utf8');
    })());
    const folder = mkdtempSync(join(tmpdir(), 'plomada-replay-'));
    const heard = session.split('\n').map((line) => /^\d+ < (.*)$/.exec(line)?.[1]).filter((line) => line !== undefined).map((line) => `${line}\r\n`).join('');
    const file = (name: string, content: string): string => {
      writeFileSync(join(folder, name), content);
      return join(folder, name);
    };
    const paths = [
      file('session.txt', session), file('console.txt', heard),
      file('xctu.log', `02-05-2015 11:44:56.017,-,RECV,${Buffer.from(heard).toString('hex').toUpperCase()}\n`),
    ];
    execFileSync(PLOMADA, ['log', paths[1]!, '-o', folder]); // status 0: the firmware's own dump is whole
    await tab(page, 'Replay').click();
    await openFiles('Open a file', ...paths, join(folder, 'console.csv'));
    await page.waitForFunction(() => document.querySelectorAll('.chips li').length === 7); // of three files dump and telemetry, and the CSV
    expect(await page.locator('.banner.bad').count()).toBe(0);
    await openFiles('Open a file', file('nothing.txt', 'hello\n'));
    await shows('neither a flight CSV, nor telemetry');
  });
});

describe('a link that leads elsewhere', () => {
  it('is told in plain words: silence, another rate, another device, nobody, no Web Serial', async () => {
    page = await openPage(browser, site.url);
    const cases: [Buffer | null, string][] = [
      [null, 'The port is open and nothing comes.'],
      [Buffer.from('$GPGGA,092750.000,5321.6802,N\r\n'), 'This is probably another device.'],
      [Buffer.from([0x80, 0xff, 0xe0, 0x9c, 0x80, 0x0d]), 'Octets come that are no text'],
    ];
    for (const [says, want] of cases) {
      const device = await scripted(() => undefined);
      const timer = setInterval(() => says && device.send(says), 100);
      await page.getByLabel('Address').fill(device.url);
      await button(page, 'Connect').click();
      await shows(want);
      await page.locator('.status').click();
      await button(page, 'Disconnect').click();
      clearInterval(timer);
      device.end();
    }
    await page.evaluate(() => Object.defineProperty(navigator, 'serial', { value: undefined })); // as in Safari
    await button(page, 'Choose a port').click();
    await shows('This browser has no Web Serial.');
  });
});

describe('without a mouse', () => {
  it('the vehicle is started, flown and stopped', async () => {
    page = await openPage(browser, site.url);
    await page.waitForFunction(() => document.activeElement?.textContent === 'Start the simulated vehicle');
    await page.keyboard.press('Enter');
    const reach = async (name: string): Promise<void> => {
      for (let i = 0; i < 80; i++) {
        if (await page.evaluate((want) => document.activeElement?.textContent === want, name)) return;
        await page.keyboard.press('Tab');
      }
      throw new Error(`Tab never comes to ${name}`);
    };
    await reach('5×');
    await page.keyboard.press('Enter');
    await untilLaserIsOk(page);
    await reach('Take off');
    await page.keyboard.press('Enter');
    await untilHeight(page, 0.6, 0.06);
    await page.keyboard.press('Escape');
    await page.waitForSelector('.stop.answered');
    await untilState(page, 'GROUND');
  });
});

describe('in Spanish', () => {
  it('nothing is left in English but what the firmware itself says', async () => {
    const walk = async (locale: string): Promise<string[]> => {
      page = await openPage(browser, site.url, { locale });
      const words = new Set<string>();
      const gather = async (): Promise<void> => {
        const found = await page.evaluate(() => {
          const texts: string[] = [];
          const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
          while (walker.nextNode()) if (!walker.currentNode.parentElement!.closest('[lang=en], code, script, .brand')) texts.push(walker.currentNode.textContent!);
          for (const element of document.querySelectorAll('[aria-label], [title], [placeholder]')) for (const name of ['aria-label', 'title', 'placeholder']) texts.push(element.getAttribute(name) ?? '');
          return texts;
        });
        for (const text of found) words.add(text.trim());
      };
      await gather();
      await page.locator('.featured button').click();
      await page.locator('.chip', { hasText: /^5×$/ }).click();
      await untilLaserIsOk(page);
      await page.locator('.figures summary').last().click();
      await gather();
      await page.locator('.go').click();
      await untilHeight(page, 0.6, 0.06);
      await page.keyboard.press('l');
      await untilState(page, 'GROUND');
      for (let view = 0; view < 6; view++) {
        await page.locator('nav button').nth(view).click();
        if (view === 1) await openGroups(page);
        await gather();
      }
      await page.context().close();
      return [...words];
    };
    const [english, spanish] = [await walk('en-GB'), new Set(await walk('es-ES'))];
    const own = new Set(execFileSync(PLOMADA, ['params'], { encoding: 'utf8' }).split(/[\s]+/).concat(['GROUND', 'FLYING', 'TAKEOFF', 'LANDING', 'STOP', 'STOP, LAND', 'Esc', 'Plomada Ground', 'JSON', 'COM', 'Firmware']));
    const same = english.filter((text) => spanish.has(text) && /[A-Za-z]{3}/.test(text) && !own.has(text) && !/^(OK|ERR|alt:|#)|^[a-z0-9]+-[a-z0-9-]+$|^[a-z_0-9]+$|^[-A-Z0-9|/*²]+$/.test(text));
    expect(same).toEqual([]);
    expect(spanish.size).toBeGreaterThan(200);
  });
});
