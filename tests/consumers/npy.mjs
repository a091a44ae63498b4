// The halves of a .npy file and its shape, last axis fastest.
import { readFileSync } from 'node:fs';
export function readNpy(path) {
    const bytes = readFileSync(path), start = 10 + bytes.readUInt16LE(8), header = bytes.toString('latin1', 10, start);
    const shape = header.match(/'shape': \(([^)]*)\)/)[1].split(',').filter(part => part.trim()).map(Number);
    if (!header.includes("'<f2'") || !header.includes("'fortran_order': False")) throw new Error(`${path}: ${header}`);
    return { shape, halves: new Uint16Array(bytes.buffer.slice(bytes.byteOffset + start, bytes.byteOffset + bytes.length)) };
}
