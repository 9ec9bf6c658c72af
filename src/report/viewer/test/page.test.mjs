// Whole pages in headless Chromium; REJOIN_PAGES names the folder with the pages (tests/report/planted_page.cpp).
import assert from 'node:assert/strict';
import {readFileSync, statSync} from 'node:fs';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {evenColour} from '../src/colours.js';
import {drawn, openBrowser, openPage, pixels, settled} from './browser.mjs';

const file = (name) => join(process.env.REJOIN_PAGES, `${name}.html`);
const CANVAS = '.stage canvas';
let browser;
before(async () => (browser = await openBrowser()));
after(() => browser?.close());

/** Opens a page, runs the body, and checks that nothing was complained of or asked for. */
async function on(name, body, size) {
  const {page, problems} = await openPage(browser.context, file(name), size);
  await body(page);
  await settled(page);
  assert.deepEqual(problems, []);
  await page.close();
}

const look = async (page) => drawn(await pixels(page, CANVAS));

async function setSlider(page, value) {
  await page.locator('#explode').evaluate((slider, to) => {
    slider.value = to;
    slider.dispatchEvent(new Event('input'));
  }, value);
  await settled(page);
}

/** A place on the picture that shows a surface: the first found from the middle outwards. */
async function surface(page) {
  const {width, height, at} = await pixels(page, CANVAS);
  const ground = at(6, 6);
  for (let reach = 0; reach < width / 2; reach += 8) {
    for (let angle = 0; angle < 6.2; angle += 0.3) {
      const [x, y] = [width / 2 + reach * Math.cos(angle), height / 2 + reach * Math.sin(angle)].map(Math.round);
      if (y > 6 && y < height - 6 && at(x, y).some((c, k) => Math.abs(c - ground[k]) > 40)) return {x, y};
    }
  }
  throw new Error('nothing is drawn');
}

test('hostile names do nothing and are shown as text', () =>
  on('hostile', async (page) => {
    assert.equal(await page.evaluate(() => window.hacked), undefined);
    assert.match(await page.textContent('h1'), /<b>run<\/b>/);
    assert.equal(await page.locator('main img[src="x"], main svg, main b > script, main i > i').count(), 0);
    assert.ok((await page.textContent('.missing')).includes('no joint <i>was</i> sure enough'));
    const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.ok(wide <= 0, `the page is ${wide} pixels too wide`);
  }));

test('names in the list are whole as far as they are written, and the ends of the gap scale stand apart', () =>
  on('hostile', async (page) => {
    const cut = await page.locator('.pick .name').evaluateAll((names) => names.filter((name) => name.scrollWidth > name.clientWidth && getComputedStyle(name).overflow === 'hidden').length);
    assert.equal(cut, 0, 'their ends tell scans apart');
    await page.selectOption('#colour', 'gap');
    const gaps = await page.locator('.legend .ends').first().evaluate((ends) => {
      const labels = ['overlap 0.00849', 'touch', 'apart 0.00849'];
      return [...ends.children].map((label, k) => ((label.textContent = labels[k]), label)).map((label) => label.getBoundingClientRect()).slice(0, 2).map((box, k) => ends.children[k + 1].getBoundingClientRect().left - box.right);
    });
    assert.ok(Math.min(...gaps) >= 12, `${gaps} pixels between the labels`);
  }));

test('the viewer draws the placed fragments, and loose ones on demand', () =>
  on('hostile', async (page) => {
    const placed = await look(page);
    assert.ok(placed.share > 0.05 && placed.share < 0.9, `${placed.share}`);
    for (const box of await page.locator('.fragments input').all()) if (await box.isChecked()) await box.uncheck();
    await settled(page);
    assert.equal((await look(page)).share, 0);
    await page.click('#loose');
    await settled(page);
    assert.ok((await look(page)).share > 0.02);
  }));

test('the slider pulls the fragments apart, and back', () =>
  on('hostile', async (page) => {
    await page.locator('.fragments input').nth(2).uncheck();
    await page.click('text=Fit');
    await settled(page);
    const together = await pixels(page, CANVAS);
    await setSlider(page, 200);
    const apart = await pixels(page, CANVAS);
    const gap = ({width, height, at}) => {
      let rows = 0;
      const ground = at(6, 6);
      const {top, bottom} = drawn({width, height, at});
      for (let y = top; y < bottom; ++y) {
        let empty = true;
        for (let x = 6; x < width - 6 && empty; x += 3) empty = at(x, y).every((c, k) => Math.abs(c - ground[k]) < 12);
        rows += empty ? 1 : 0;
      }
      return rows;
    };
    assert.equal(gap(together), 0, 'joined halves are one');
    assert.ok(gap(apart) > 10, 'background shows between the halves');
    await setSlider(page, 0);
    await page.click('text=Fit');
    await settled(page);
    const back = await pixels(page, CANVAS);
    assert.equal(gap(back), 0);
  }));

test('a click chooses the fragment under it, a click beside it none', () =>
  on('hostile', async (page) => {
    await page.locator('.fragments input').nth(0).uncheck();
    await page.locator('.fragments input').nth(2).uncheck();
    await page.click('text=Fit');
    await settled(page);
    await page.locator(CANVAS).click({position: await surface(page)});
    assert.equal(await page.locator('.fragments li.chosen').count(), 1);
    assert.ok((await page.locator('.fragments li').nth(1).getAttribute('class')).includes('chosen'));
    assert.ok((await page.textContent('#chosen')).includes('window.hacked=4'));
    await page.locator(CANVAS).click({position: {x: 4, y: 4}});
    assert.equal(await page.locator('.fragments li.chosen').count(), 0);
  }));

test('dragging turns the view and does not choose', () =>
  on('hostile', async (page) => {
    const before = await look(page);
    await page.locator(CANVAS).scrollIntoViewIfNeeded();
    const box = await page.locator(CANVAS).boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width / 2 + 150, box.y + box.height / 2 + 60, {steps: 5});
    await page.mouse.up();
    await settled(page);
    assert.notDeepEqual(await look(page), before);
    assert.equal(await page.locator('.fragments li.chosen').count(), 0);
  }));

test('all of it works from the keyboard', () =>
  on('hostile', async (page) => {
    await page.focus(CANVAS);
    const before = await look(page);
    await page.keyboard.press('ArrowLeft');
    await settled(page);
    assert.notDeepEqual(await look(page), before);
    await page.keyboard.press('n');
    await page.keyboard.press('n');
    assert.ok((await page.locator('.fragments li').nth(1).getAttribute('class')).includes('chosen'));
    await page.keyboard.press('h');
    assert.equal(await page.locator('.fragments input').nth(1).isChecked(), false);
    await page.keyboard.press('a');
    assert.equal(await page.locator('.fragments input').nth(1).isChecked(), true);
    await page.keyboard.press(']');
    assert.equal(await page.inputValue('#explode'), '10');
    await page.focus('#matrix canvas');
    await page.keyboard.press('ArrowRight');
    await page.keyboard.press('ArrowLeft');
    assert.match(await page.textContent('.readout'), /score 0\.97/);
    await page.keyboard.press('Enter');
    assert.equal(await page.evaluate(() => document.activeElement.id), 'join-0');
    await page.locator('.enlarge').first().focus();
    await page.keyboard.press('Enter');
    assert.ok(await page.locator('dialog').isVisible());
    await page.keyboard.press('Escape');
    assert.ok(!(await page.locator('dialog').isVisible()));
  }));

test('colours by confidence and by gap change the picture and are explained', () =>
  on('hostile', async (page) => {
    const seen = new Set();
    for (const mode of ['fragment', 'object', 'confidence', 'gap']) {
      await page.selectOption('#colour', mode);
      await settled(page);
      seen.add((await page.locator(CANVAS).screenshot()).toString('base64'));
    }
    assert.equal(seen.size, 4);
    assert.match(await page.textContent('.view .legend'), /overlap.*touch.*apart/);
  }));

test('pictures of joins are there and decode', () =>
  on('hostile', async (page) => {
    const sizes = await page.locator('.pictures img').evaluateAll(async (images) => {
      for (const image of images) image.loading = 'eager';
      await Promise.all(images.map((image) => image.decode()));
      return images.map((image) => [image.naturalWidth, image.naturalHeight, image.width > 0]);
    });
    assert.equal(sizes.length, 7);
    for (const [width, height, shown] of sizes) assert.ok(width > 100 && height > 50 && shown);
  }));

test('decisions on joins become a constraints file, which goes on with the last one', () =>
  on('hostile', async (page) => {
    const data = JSON.parse(await page.textContent('#report'));
    const names = data.fragments.map(({name}) => name);
    const saved = async () => {
      const [download] = await Promise.all([page.waitForEvent('download'), page.click('text=Save constraints.json')]);
      const json = JSON.parse(readFileSync(await download.path(), 'utf8'));
      assert.deepEqual(json, JSON.parse(await page.inputValue('.decisions textarea')));
      return json;
    };
    const {poses} = await saved();
    assert.deepEqual(await saved(), {must_not_join: [[names[2], names[0]]], poses});
    assert.deepEqual(poses, {[names[2]]: [[1, 0, 0, 0.1], [0, 1, 0, -2], [0, 0, 1, 3e12], [0, 0, 0, 1]]});
    await page.click('.next button');
    assert.equal(await page.locator('.join').count(), 1);
    assert.ok((await page.textContent('.join')).includes('unsure'));
    await page.click('.join >> text="They join"');
    assert.deepEqual((await saved()).must_join, [[names[2], names[3]]]);
    await page.click('.join >> text="They do not join"');
    assert.equal(await page.getAttribute('.join >> text="They join"', 'aria-pressed'), 'false');
    assert.deepEqual(await saved(), {must_not_join: [[names[2], names[0]], [names[2], names[3]]], poses});
    await page.click('.join >> text="They do not join"');
    assert.deepEqual(await saved(), {must_not_join: [[names[2], names[0]]], poses});
    assert.match(await page.textContent('.decisions'), /1 decision and 1 given pose, those of the last/);
  }));

test('poses given to the last assembly are kept where nothing else was decided', () =>
  on('posed', async (page) => {
    assert.match(await page.textContent('.decisions'), /1 given pose of the last assembly\. Save/);
    assert.deepEqual(Object.keys(JSON.parse(await page.inputValue('.decisions textarea'))), ['poses']);
  }));

test('a phone shows it without scrolling sideways', () =>
  on(
    'hostile',
    async (page) => {
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth - innerWidth), 0);
      assert.ok((await look(page)).share > 0.03);
    },
    {width: 390, height: 844},
  ));

test('a phone shows names whole, and their commas beside them', () =>
  on(
    'sixty',
    async (page) => {
      const shown = await page.evaluate(() => {
        const lines = (element) => Math.round(element.getBoundingClientRect().height / parseFloat(getComputedStyle(element).lineHeight));
        return {
          names: [...document.querySelectorAll('.members .member')].map((member) => [lines(member), member.textContent]),
          room: document.querySelector('.members').clientWidth,
          links: [...document.querySelectorAll('.top nav a')].map(lines),
        };
      });
      assert.equal(shown.names.length, 60);
      shown.names.forEach(([lines, text], k) => assert.deepEqual([lines, text], [1, `ball ${k}${k < 59 ? ',' : ''}`]));
      assert.ok(shown.room > 320, `${shown.room}`);
      assert.ok(shown.links.every((count) => count === 1));
    },
    {width: 390, height: 844},
  ));

test('a button of a piece keeps the focus', () =>
  on('hostile', async (page) => {
    await page.locator('.fragments .pick').first().click();
    const hide = page.locator('.card .buttons button').first();
    await hide.focus();
    await page.keyboard.press('Enter');
    assert.equal(await page.evaluate(() => document.activeElement.textContent), 'Show');
    await page.keyboard.press('Enter');
    assert.equal(await page.evaluate(() => document.activeElement.textContent), 'Hide');
  }));

test('the matrix of a phone follows the cursor', () =>
  on(
    'many',
    async (page) => {
      await page.focus('#matrix canvas');
      const scrolled = () => page.locator('#matrix .matrix').evaluate((box) => [box.scrollLeft, box.scrollWidth - box.clientWidth]);
      assert.ok((await scrolled())[1] > 0);
      for (let k = 0; k < 200; ++k) await page.keyboard.press('ArrowRight');
      const [at, most] = await scrolled();
      assert.ok(at > most - 2, `${at} of ${most}`);
      for (let k = 0; k < 200; ++k) await page.keyboard.press('ArrowDown');
      const below = await page.locator('#matrix canvas').evaluate((canvas) => canvas.getBoundingClientRect().bottom - window.innerHeight);
      assert.ok(below < 20, `${below}`);
    },
    {width: 390, height: 300},
  ));

test('the matrix of a phone names its rows and columns', () =>
  on(
    'hostile',
    async (page) => {
      const {at} = await pixels(page, '#matrix canvas');
      const ground = at(2, 2);
      const ink = (left, top, width, height) => {
        let count = 0;
        for (let x = left; x < left + width; ++x) for (let y = top; y < top + height; ++y) count += at(x, y).some((c, k) => Math.abs(c - ground[k]) > 60) ? 1 : 0;
        return count;
      };
      for (let k = 0; k < 4; ++k) {
        assert.ok(ink(0, 98 + 28 * k, 90, 24) > 20, `row ${k}`);
        assert.ok(ink(98 + 28 * k, 0, 24, 90) > 20, `column ${k}`);
      }
    },
    {width: 390, height: 844},
  ));

test('cells of the matrix have the colours of the scores that the pointer reads there', () =>
  on('hostile', async (page) => {
    const canvas = page.locator('#matrix canvas');
    await canvas.scrollIntoViewIfNeeded();
    const {width, at} = await pixels(page, '#matrix canvas');
    const count = await page.locator('.fragments li').count();
    const cell = 28;
    const first = width - cell * count;
    const plain = {own: new Set(), none: new Set()};
    let compared = 0;
    for (let row = 0; row < count; ++row) {
      for (let column = 0; column < count; ++column) {
        const [x, y] = [first + cell * column + cell / 2, first + cell * row + cell / 2];
        await canvas.hover({position: {x, y}});
        const score = /score ([\d.]+)/.exec(await page.textContent('.readout'))?.[1];
        const shown = at(x, y);
        if (score === undefined) plain[row === column ? 'own' : 'none'].add(String(shown));
        else assert.ok(evenColour(Number(score)).every((c, k) => Math.abs(255 * c - shown[k]) < 6), `${row} ${column}: ${shown} for ${score}`);
        if (score !== undefined) ++compared;
      }
    }
    assert.ok(compared > 0);
    assert.equal(plain.own.size, 1);
    assert.equal(plain.none.size, 1);
  }));

test('dark and light differ, and both keep their text legible', () =>
  on('hostile', async (page) => {
    const contrast = () =>
      page.evaluate(() => {
        const light = (text) => {
          const [r, g, b] = text.match(/[\d.]+/g).map((c) => (c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4));
          return 0.2126 * r + 0.7152 * g + 0.0722 * b;
        };
        const paper = light(getComputedStyle(document.body).backgroundColor);
        return ['body', '.counts li', '.top a', 'button.link', '.verdict', '.note'].map((selector) => {
          const ink = light(getComputedStyle(document.querySelector(selector)).color);
          return (Math.max(ink, paper) + 0.05) / (Math.min(ink, paper) + 0.05);
        });
      });
    const light = await contrast();
    await page.click('.theme');
    const dark = await contrast();
    for (const ratio of [...light, ...dark]) assert.ok(ratio >= 4.5, `${light} ${dark}`); // WCAG 2, AA
    assert.notDeepEqual(light, dark);
  }));

test('a run without fragments is a page too', () => on('empty', async (page) => assert.match(await page.textContent('.counts'), /0fragments/)));

test('sixty fragments with pictures stay under 30 MB and can be chosen', () =>
  on('sixty', async (page) => {
    assert.ok(statSync(file('sixty')).size < 30e6);
    assert.ok((await look(page)).share > 0.01);
    await page.fill('.filter', 'ball 59');
    await page.click('.fragments .pick');
    assert.match(await page.textContent('#chosen'), /ball 59/);
    const colour = await page.locator('.fragments .swatch').first().evaluate((swatch) => getComputedStyle(swatch).backgroundColor);
    assert.doesNotMatch(colour, /rgba\(0, 0, 0, 0\)/);
  }));
