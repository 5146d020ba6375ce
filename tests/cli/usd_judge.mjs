// SPDX-License-Identifier: Apache-2.0
// Reads USD files with tinyusdz, and writes what it read as text beside each: FILE.read.
// Run: node usd_judge.mjs FOLDER_OF_TINYUSDZ FILE...
import fs from "fs";

const [folder, ...files] = process.argv.slice(2);
// The module is made for browsers, and refuses to run elsewhere.
process.type = "renderer";
globalThis.window = globalThis;
const binary = fs.readFileSync(`${folder}/tinyusdz.wasm`);
const make = (await import(`${folder}/tinyusdz.js`)).default;
const usd = await make({
  instantiateWasm(imports, done) {
    WebAssembly.instantiate(binary, imports).then((made) => done(made.instance, made.module));
    return {};
  },
});
for (const file of files) {
  const loader = new usd.TinyUSDZLoaderNative();
  if (!loader.loadAsLayerFromBinary(fs.readFileSync(file), file)) {
    console.error(`${file}: ${loader.error()}`);
    process.exit(1);
  }
  fs.writeFileSync(`${file}.read`, loader.layerToString());
}
