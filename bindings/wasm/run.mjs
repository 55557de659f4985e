// Runs a program of WASI in node, with the whole file system: node run.mjs PROGRAM.wasm ARGUMENTS...
import { readFileSync } from 'node:fs'
import { WASI } from 'node:wasi'

const wasi = new WASI({ version: 'preview1', args: process.argv.slice(2), preopens: { '/': '/' } })
const module = await WebAssembly.compile(readFileSync(process.argv[2]))
process.exitCode = wasi.start(await WebAssembly.instantiate(module, wasi.getImportObject()))
