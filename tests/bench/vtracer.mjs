// vtracer at its finest on one picture, to be timed beside ours in one run:
//
//   npm install --prefix PEERS @neplex/vectorizer@0.1.0
//   tessera-cli bench DIR --peer 'node tests/bench/vtracer.mjs PEERS {in}'
//
// Colour precision 8, layer difference 4, no speckle filter; all else as vtracer's own program has it. With a third
// argument the drawing is written there.
import { readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { resolve } from 'node:path';

const [folder, picture, output] = process.argv.slice(2);
if (!picture) {
    console.error('usage: node vtracer.mjs FOLDER_WITH_NODE_MODULES PICTURE [OUT.svg]');
    process.exit(2);
}
const { vectorizeSync, ColorMode, Hierarchical, PathSimplifyMode } = createRequire(resolve(folder, 'package.json'))(
    '@neplex/vectorizer');

const svg = vectorizeSync(readFileSync(picture), {
    colorMode: ColorMode.Color,
    hierarchical: Hierarchical.Stacked,
    mode: PathSimplifyMode.Spline,
    colorPrecision: 8,
    layerDifference: 4,
    filterSpeckle: 0,
    cornerThreshold: 60,
    lengthThreshold: 4,
    maxIterations: 10,
    spliceThreshold: 45,
    pathPrecision: 2,
});
if (output) writeFileSync(output, svg);
