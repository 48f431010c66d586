// The manual in a real browser: `CHROMIUM=PATH node book.mjs BOOK`.
//
// Every page in a light and a dark theme: nothing is fetched from elsewhere, the console has no error, all pictures load, and
// axe-core finds nothing in the page's own content.

import { readdirSync } from 'node:fs';
import { resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import axe from 'axe-core';
import { chromium } from 'playwright-core';

const folder = resolve(process.argv[2]);
const pages = readdirSync(folder).filter((name) => name.endsWith('.html') && !['print.html', 'toc.html', '404.html'].includes(name));
const args = process.getuid?.() === 0 ? ['--no-sandbox'] : [];
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM, args });
const found = [];

for (const colorScheme of ['light', 'dark']) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, colorScheme });
  const page = await context.newPage();
  page.setDefaultTimeout(120_000);
  let name = '';
  const wrong = (what) => found.push(`${name}, ${colorScheme}: ${what}`);
  page.on('console', (message) => message.type() === 'error' && wrong(message.text()));
  page.on('pageerror', (error) => wrong(String(error)));
  page.on('request', (request) => !/^(file|data|blob|about):/.test(request.url()) && wrong(`it asks for ${request.url()}`));
  for (name of pages) {
    await page.goto(pathToFileURL(`${folder}/${name}`).href);
    const broken = await page.evaluate(() => [...document.images].filter((one) => !one.naturalWidth).map((one) => one.src));
    broken.forEach((source) => wrong(`${source} does not load`));
    await page.evaluate(axe.source);
    const { violations } = await page.evaluate(() => axe.run('main', { resultTypes: ['violations'], preload: false }));
    violations.forEach(({ id, nodes }) => wrong(`${id}: ${nodes.length} × ${nodes[0].html.slice(0, 160)}`));
  }
  await context.close();
}
await browser.close();
console.log(found.join('\n') || `${pages.length} pages in two themes: axe-core finds nothing`);
process.exit(found.length ? 1 : 0);
