// The page of a run in a real browser: `CHROMIUM=PATH node report.mjs REPORT.html [SCREENSHOTS]`.
//
// At three widths in both themes: nothing is fetched, the console is silent, nothing is wider than the window, and
// axe-core finds nothing. The map, values of plots, filters, sorting, addresses, rows and copying do what they say, by
// keyboard, too, and without JavaScript all is readable.

import assert from 'node:assert/strict';
import { mkdirSync } from 'node:fs';
import { resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import axe from 'axe-core';
import { chromium } from 'playwright-core';

const [report, folder] = process.argv.slice(2);
const url = pathToFileURL(resolve(report)).href;
const widths = [360, 1280, 3840];
const themes = ['light', 'dark'];

// A container's root has no sandbox of Chromium's.
const args = process.getuid?.() === 0 ? ['--no-sandbox'] : [];
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM, args });

// A page with the report; what goes wrong on it is collected.
const open = async (options = {}) => {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, ...options });
  const page = await context.newPage();
  // A busy machine is no fault of the page.
  page.setDefaultTimeout(120_000);
  const wrong = [];
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && wrong.push(message.text()));
  page.on('pageerror', (error) => wrong.push(String(error)));
  const isOwn = (address) => [url, 'about:blank'].includes(address.split('#')[0]);
  page.on('request', (request) => !isOwn(request.url()) && wrong.push(`it asks for ${request.url()}`));
  await page.goto(url);
  return { page, close: async () => { assert.deepEqual(wrong, []); await context.close(); } };
};

const shown = (page) => page.locator('#table > tbody:visible').count();
const rowOf = (page, place) => page.locator('#table > tbody').nth(place);

// What axe-core finds, with the first element of each, in twenty rows and five cases: it is slow, and the others
// are of the same form.
const audit = async (page) => {
  await page.evaluate(() => document.querySelectorAll(
    '#table > tbody:nth-of-type(n + 21), details.case:nth-of-type(n + 6)').forEach((one) => one.remove()));
  await page.evaluate(axe.source);
  const found = await page.evaluate(() => axe.run(document, { resultTypes: ['violations'] }));
  return found.violations.map(({ id, nodes }) => `${id}: ${nodes.length} × ${nodes[0].html.slice(0, 200)}`);
};

const looks = async () => {
  for (const width of widths) {
    const { page, close } = await open({ viewport: { width, height: Math.max(740, Math.round(width * 0.56)) } });
    const inThemes = async (part, look = async () => {}) => {
      for (const colorScheme of themes) {
        await page.emulateMedia({ colorScheme });
        if (folder) await page.screenshot({ path: `${folder}/${width}-${colorScheme}-${part}.png` });
        await look(`${width} pixels, ${colorScheme}`);
      }
    };
    await inThemes('first');
    await page.locator('details.case > summary').first().click();
    const rows = [rowOf(page, 0), page.locator('#table > tbody:has(table)').first()];
    for (const row of rows) await row.locator('th > details').evaluate((one) => { one.open = true; });
    const [wide, window] =
      await page.evaluate(() => [document.documentElement.scrollWidth, document.documentElement.clientWidth]);
    assert.ok(wide <= window, `${wide} pixels in a window of ${window}`);
    await rows[1].evaluate((row) => row.scrollIntoView());
    await inThemes('row', async (name) => assert.deepEqual(await audit(page), [], name));
    await close();
  }
};

// What the last row is in regard of a choice, and how many rows are.
const chosen = (name) => {
  const bodies = [...document.querySelectorAll('#table > tbody')];
  const own = (body) => body.dataset[name] ?? document.getElementById(`case-${body.dataset.case}`).dataset[name];
  const value = own(bodies.at(-1));
  return { value, some: bodies.filter((body) => own(body) === value).length };
};

const filters = async () => {
  const { page, close } = await open();
  const all = await page.locator('#table > tbody').count();
  assert.equal(await shown(page), all);
  for (const name of ['verdict', 'problem', 'medium', 'estimator']) {
    const { value, some } = await page.evaluate(chosen, name);
    await page.selectOption(`#filters [name=${name}]`, `=${value}`);
    assert.ok(some > 0);
    assert.equal(await shown(page), some);
    assert.equal(await page.textContent('#shown'), `${some} of ${all}`);
    await page.click('#filters [type=reset]');
    await page.waitForFunction((all) => document.querySelector('#shown').textContent === `${all} of ${all}`, all);
  }
  await page.fill('#filters [name=text]', 'no experiment is called so');
  assert.equal(await shown(page), 0);
  assert.ok(await page.isVisible('#none'));
  await close();
};

// z is sorted by its size.
const sorting = async () => {
  const { page, close } = await open();
  const head = page.locator('#table > thead th', { hasText: /^z$/ });
  const sizes = () => page.$$eval('#table > tbody > tr:first-child > td:nth-child(5)', (cells) => cells
    .map((cell) => Math.abs(Number(cell.textContent.replace(/[()]/g, '')))).filter((size) => !Number.isNaN(size)));
  const before = await sizes();
  await head.locator('button').click();
  assert.equal(await head.getAttribute('aria-sort'), 'ascending');
  assert.deepEqual(await sizes(), [...before].sort((a, b) => a - b));
  await head.locator('button').click();
  assert.equal(await head.getAttribute('aria-sort'), 'descending');
  assert.deepEqual(await sizes(), [...before].sort((a, b) => b - a));
  await close();
};

// An address keeps what is chosen, and opens the row that it names.
const addresses = async () => {
  const { page, close } = await open();
  await page.selectOption('#filters [name=verdict]', '=pass');
  await page.fill('#filters [name=text]', 'ratio');
  const some = await shown(page);
  const row = await page.locator('#table > tbody:visible').first().getAttribute('id');
  await page.goto('about:blank');
  await page.goBack();
  assert.equal(await page.inputValue('#filters [name=text]'), 'ratio');
  assert.equal(await shown(page), some);
  await page.evaluate((row) => { location.hash = row; }, row);
  await page.locator(`[id="${row}"] > .more`).waitFor();
  await page.emulateMedia({ media: 'print' });
  assert.match(await page.textContent('#chosen'), /of \d+: text ratio, verdict pass$/);
  assert.ok(await page.isVisible('#chosen'));
  // An address that cannot be decoded is no error.
  await page.evaluate(() => { location.hash = '%'; });
  await close();
};

// The bubble with an explanation or a value.
const bubble = (page) => page.locator('.tip');

// A cell of the map names its experiment and opens its row; the map is one stop of the tabulator.
const map = async () => {
  const { page, close } = await open();
  const cells = page.locator('.map a.cell');
  const ids = await cells.evaluateAll((all) => all.map((cell) => decodeURIComponent(cell.hash.slice(1))));
  assert.ok(ids.length > 0);
  assert.ok(await page.evaluate((ids) => ids.every((id) => document.getElementById(id)?.matches('tbody')), ids));
  assert.equal(await page.locator('.map a.cell[tabindex="0"]').count(), 1);
  await page.keyboard.press('Tab');
  await cells.first().focus();
  await page.keyboard.press('ArrowRight');
  const said = await page.evaluate(() => document.activeElement.dataset.tip);
  assert.equal(await page.evaluate(() => document.activeElement.getAttribute('aria-label')), said);
  assert.equal(await bubble(page).textContent(), said);
  await page.keyboard.press('Escape');
  assert.ok(!await bubble(page).isVisible());
  await cells.last().click();
  await page.locator(`[id="${ids.at(-1)}"] > .more`).waitFor();
  await close();
};

// Points of plots have values, under the pointer and by the arrow keys; headings and verdicts have explanations.
const values = async () => {
  const { page, close } = await open();
  const histogram = page.locator('.pictures > section svg.plot');
  const [at, text] = await histogram.evaluate((svg) => {
    const [, x, y, text] = svg.dataset.tips.split('\n').at(8).match(/^(\S+) (\S+) (.*)$/);
    const { x: left, y: top } = new DOMPoint(Number(x), Number(y)).matrixTransform(svg.getScreenCTM());
    return [[left, top], text];
  });
  await page.mouse.move(at[0] + 2, at[1] + 2);
  assert.equal(await bubble(page).textContent(), text);
  await page.mouse.move(2, 2);
  assert.ok(!await bubble(page).isVisible());
  const place = await page.evaluate(() => [...document.querySelectorAll('details.case')].findIndex((one) => {
    const id = one.querySelector('.plot use')?.getAttribute('href').slice(1);
    return id && document.getElementById(id).dataset.tips.includes('\n');
  }));
  assert.ok(place >= 0, 'a case has a plot with values');
  const plot = page.locator('details.case').nth(place);
  await plot.locator(':scope > summary').click();
  await plot.locator('.wide').first().focus();
  const said = [];
  for (const key of ['ArrowRight', 'ArrowRight', 'ArrowLeft']) {
    await page.keyboard.press(key);
    said.push(await bubble(page).textContent());
  }
  assert.ok(said[0].length > 0 && said[0] !== said[1] && said[0] === said[2], said.join('; '));
  for (const one of ['#table > thead th:nth-child(5) button', '.counts li']) {
    await page.locator(one).first().hover();
    assert.ok((await bubble(page).textContent()).length > 20 && await bubble(page).isVisible());
  }
  await close();
};

const keyboard = async () => {
  const { page, close } = await open();
  await page.keyboard.press('Tab');
  assert.equal(await page.evaluate(() => document.activeElement.className), 'skip');
  await page.keyboard.press('Enter');
  assert.ok(page.url().endsWith('#experiments'));
  const row = page.locator('#table > tbody:has(.copy)').first();
  const more = row.locator('.more');
  assert.ok(!await more.isVisible());
  await row.locator('th > details > summary').focus();
  await page.keyboard.press('Enter');
  assert.ok(await more.isVisible());
  const focused = () => page.evaluate(() => document.activeElement.textContent);
  for (let stop = 0; stop < 12 && await focused() !== 'Copy'; stop += 1) await page.keyboard.press('Tab');
  assert.equal(await focused(), 'Copy');
  await page.keyboard.press('Enter');
  await more.locator('button', { hasText: /Copied|Selected/ }).waitFor();
  await close();
};

const withoutScript = async () => {
  const { page, close } = await open({ javaScriptEnabled: false });
  assert.ok(!await page.isVisible('#filters') && !await page.locator('.copy').first().isVisible());
  const plotted = page.locator('details.case:has(.plot)').first();
  await plotted.locator(':scope > summary').click();
  const box = await plotted.locator('.plot').first().boundingBox();
  assert.ok(box.width > 300 && box.height > 100, 'a plot has a size');
  await rowOf(page, 0).locator('th > details > summary').click();
  assert.ok(await rowOf(page, 0).locator('.more').isVisible());
  assert.ok(await page.isVisible('#legend') && await page.locator('.map a.cell[title]').count() > 0);
  await close();
};

const print = async () => {
  const { page, close } = await open();
  await page.emulateMedia({ media: 'print' });
  assert.ok(!await page.isVisible('#filters') && await page.isVisible('#table'));
  await close();
};

if (folder) mkdirSync(folder, { recursive: true });
for (const part of [looks, map, values, filters, sorting, addresses, keyboard, withoutScript, print]) {
  const begin = Date.now();
  await part();
  console.log(`${part.name}: ${((Date.now() - begin) / 1000).toFixed(1)} s`);
}
await browser.close();
