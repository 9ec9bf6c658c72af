// Headless Chromium for the tests of the page.
import {mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';
import {chromium} from 'playwright-core';

const FLAGS = [
  '--no-sandbox',
  '--disable-gpu',
  '--enable-unsafe-swiftshader',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
];

// Frames are drawn in software: on a busy machine one may take half a minute.  CTest's limit ends a page that hangs.
const PATIENCE_MS = 600e3;

/** A browser with an empty profile; close() removes it. */
export async function openBrowser() {
  const profile = mkdtempSync(join(tmpdir(), 'rejoin-chromium-'));
  const context = await chromium.launchPersistentContext(profile, {executablePath: process.env.REJOIN_CHROMIUM ?? '/usr/bin/chromium', headless: true, args: FLAGS, viewport: {width: 900, height: 600}});
  context.setDefaultTimeout(PATIENCE_MS);
  const close = async () => {
    await context.close();
    rmSync(profile, {recursive: true, force: true});
  };
  return {context, close};
}

/** Opens a page from disk and waits until it has drawn; `problems` collects console errors and requests. */
export async function openPage(context, file, size) {
  const page = await context.newPage();
  if (size) await page.setViewportSize(size);
  const problems = [];
  page.on('pageerror', (error) => problems.push(`exception: ${error.message}`));
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && !DRIVER.test(message.text()) && problems.push(`${message.type()}: ${message.text()}`));
  page.on('request', (request) => /^(data|blob|file):/.test(request.url()) || problems.push(`request: ${request.url()}`));
  page.on('dialog', (dialog) => problems.push(`dialog: ${dialog.message()}`) && dialog.dismiss());
  const begin = performance.now();
  await page.goto(pathToFileURL(file).href);
  await page.waitForSelector('body.ready');
  await settled(page);
  return {page, problems, seconds: (performance.now() - begin) / 1000};
}

// What software drivers say about themselves when pixels are read back.
const DRIVER = /GPU stall due to ReadPixels|GL Driver Message/;

/** Two frames later all that was asked for is drawn. */
export async function settled(page) {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
}

/** Rows of [red, green, blue] of an element's screenshot, through the browser's own decoder. */
export async function pixels(page, selector) {
  const shot = (await page.locator(selector).screenshot()).toString('base64');
  const {width, height, text} = await page.evaluate(async (png) => {
    const bytes = Uint8Array.from(atob(png), (c) => c.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], {type: 'image/png'}));
    const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
    context.drawImage(bitmap, 0, 0);
    const data = context.getImageData(0, 0, bitmap.width, bitmap.height).data;
    const parts = [];
    for (let k = 0; k < data.length; k += 8192) parts.push(String.fromCharCode(...data.subarray(k, k + 8192)));
    return {width: bitmap.width, height: bitmap.height, text: btoa(parts.join(''))};
  }, shot);
  const values = Buffer.from(text, 'base64');
  const at = (x, y) => [...values.subarray(4 * (y * width + x), 4 * (y * width + x) + 3)];
  return {width, height, at};
}

/** Where a picture differs from its background (its upper left corner): share, and box in pixels. */
export function drawn({width, height, at}, margin = 6) {
  const ground = at(margin, margin);
  let count = 0;
  const box = {left: width, right: 0, top: height, bottom: 0};
  for (let y = margin; y < height - margin; y += 2) {
    for (let x = margin; x < width - margin; x += 2) {
      if (at(x, y).every((c, k) => Math.abs(c - ground[k]) < 12)) continue;
      ++count;
      box.left = Math.min(box.left, x);
      box.right = Math.max(box.right, x);
      box.top = Math.min(box.top, y);
      box.bottom = Math.max(box.bottom, y);
    }
  }
  return {share: (4 * count) / ((width - 2 * margin) * (height - 2 * margin)), ...box};
}
