// node march_in_wasm.mjs MODULE MEMORY FUNCTION: call a function of the core's WebAssembly module with the record at the
// beginning of a memory image, which is placed at the address that stands in its first 8 bytes; write the image back.
import { readFileSync, writeFileSync } from "node:fs";

const [, , module, image, name] = process.argv;
const nothing = new Proxy({}, { get: () => () => 0 });
const imports = new Proxy({}, { get: () => nothing });
const { instance } = await WebAssembly.instantiate(readFileSync(module), imports);
instance.exports._initialize?.();
const bytes = readFileSync(image);
const at = Number(bytes.readBigUInt64LE(0));
const memory = instance.exports.memory;
const missing = at + bytes.length - memory.buffer.byteLength;
if (missing > 0) memory.grow(Math.ceil(missing / 65536));
new Uint8Array(memory.buffer).set(bytes, at);
instance.exports[name](at + 64);
writeFileSync(image, new Uint8Array(memory.buffer, at, bytes.length));
