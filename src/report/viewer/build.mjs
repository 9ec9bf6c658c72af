// Bundles the page and writes it as C++.  Usage: node build.mjs OUTPUT.cpp DEPFILE
import {createHash} from 'node:crypto';
import {readFileSync, writeFileSync} from 'node:fs';
import {dirname, join, resolve} from 'node:path';
import {fileURLToPath} from 'node:url';
import * as esbuild from 'esbuild';

const folder = dirname(fileURLToPath(import.meta.url));
const [output, depfile] = process.argv.slice(2);

// The licence of both libraries in the bundle wants its text kept.
const banner = `/* Contains three.js (c) 2010-2026 three.js authors and the decoder of meshoptimizer (c) 2016-2026 Arseny Kapoulkine.
${readFileSync(join(folder, 'node_modules/three/LICENSE'), 'utf8').trim().replaceAll('\u00a9', '(c)')} */`;

const bundle = async (entry, options) => {
  const result = await esbuild.build({
    absWorkingDir: folder,
    entryPoints: [entry],
    bundle: true,
    minify: true,
    write: false,
    metafile: true,
    charset: 'ascii',
    legalComments: 'none',
    target: ['chrome100', 'firefox100', 'safari15.4'],
    ...options,
  });
  return {text: result.outputFiles[0].text, inputs: Object.keys(result.metafile.inputs)};
};

const script = await bundle('src/main.js', {format: 'iife', banner: {js: banner}});
const style = await bundle('src/page.css', {});
if (/<\/(script|style)/i.test(script.text + style.text)) throw new Error('the bundle would end its own element');

const hash = (text) => `sha256-${createHash('sha256').update(text).digest('base64')}`;

// Compilers limit the length of one literal, so the text comes in pieces.
const literal = (text) => {
  const pieces = text.match(/[\s\S]{1,8000}/g) ?? [''];
  return pieces.map((piece) => `R"~page~(${piece})~page~"`).join('\n    ');
};
if ((script.text + style.text).includes(')~page~"')) throw new Error('the bundle would end its C++ literal');

writeFileSync(output, `#include "report/detail/page_files.hpp"

namespace rejoin::report::detail {

PageFiles page_files() {
  static constexpr char kScript[] =
    ${literal(script.text)};
  static constexpr char kStyle[] =
    ${literal(style.text)};
  return {{kScript, sizeof(kScript) - 1}, {kStyle, sizeof(kStyle) - 1}, "${hash(script.text)}", "${hash(style.text)}"};
}

}  // namespace rejoin::report::detail
`);

const inputs = [...script.inputs, ...style.inputs].map((name) => resolve(folder, name).replaceAll(' ', '\\ '));
writeFileSync(depfile, `${output.replaceAll(' ', '\\ ')}: ${inputs.join(' \\\n  ')}\n`);
