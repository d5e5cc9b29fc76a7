// The first .ifc file of a zip archive.
// SPDX-License-Identifier: MIT
//
// PKWARE. APPNOTE, .ZIP File Format Specification. Without encryption, ZIP64 and other methods than stored and deflated.
import zlib from 'node:zlib';

import {Fault} from './step.mjs';

const kLargest = 2 ** 31 - 1; // [bytes]

/** Throws a Fault if there is none, or it is broken. */
export function unpackIfc(zip) {
    const broken = () => new Fault('is no zip archive, or a broken one: get the file again');
    const end = zip.lastIndexOf('PK\x05\x06', undefined, 'latin1');
    if (end < 0 || end + 22 > zip.length) throw broken();
    let at = zip.readUInt32LE(end + 16);
    for (let left = zip.readUInt16LE(end + 10); left > 0; --left) {
        if (at + 46 > zip.length || zip.readUInt32LE(at) !== 0x02014b50) throw broken();
        const method = zip.readUInt16LE(at + 10), packed = zip.readUInt32LE(at + 20), size = zip.readUInt32LE(at + 24);
        const name = zip.toString('utf8', at + 46, at + 46 + zip.readUInt16LE(at + 28)), local = zip.readUInt32LE(at + 42);
        at += 46 + zip.readUInt16LE(at + 28) + zip.readUInt16LE(at + 30) + zip.readUInt16LE(at + 32);
        if (!/\.ifc$/i.test(name)) continue;
        if (local + 30 > zip.length || size > kLargest) throw broken();
        const begin = local + 30 + zip.readUInt16LE(local + 26) + zip.readUInt16LE(local + 28);
        if (begin + packed > zip.length) throw broken();
        const bytes = zip.subarray(begin, begin + packed);
        if (method === 0) return Buffer.from(bytes);
        if (method !== 8) throw new Fault(`holds ${name} packed by method ${method}, which is not read: unpack it first`);
        try {
            return zlib.inflateRawSync(bytes, {maxOutputLength: Math.max(size, 1)});
        } catch {
            throw broken();
        }
    }
    throw new Fault('holds no .ifc file');
}
