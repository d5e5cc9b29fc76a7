// What web-ifc gives of a product, as one mesh of several parts, which products of the same shape share.
// SPDX-License-Identifier: MIT
import crypto from 'node:crypto';

import {Fault} from './step.mjs';

const kFarthest = 1e9; // [m], beyond which a stream of a scene is not believed
const kFine = 1e6; // what differs by less than its inverse is placed alike  [of the file's units]

/** Positions without repetition: only the very same numbers are the same; 0 and -0 are. */
export function weld(vertices, stride, corners) {
    const count = vertices.length / stride;
    let slots = 16;
    while (slots < 2 * count) slots *= 2;
    const table = new Int32Array(slots).fill(-1), map = new Uint32Array(count);
    const kept = new Float32Array(3 * count), bits = new Uint32Array(kept.buffer);
    let size = 0;
    for (let v = 0; v < count; ++v) {
        const at = 3 * size;
        for (let axis = 0; axis < 3; ++axis) kept[at + axis] = vertices[v * stride + axis] + 0;
        let slot = Math.imul(bits[at], 73856093) ^ Math.imul(bits[at + 1], 19349663) ^ Math.imul(bits[at + 2], 83492791);
        slot = (slot ^ (slot >>> 15)) & (slots - 1);
        for (;; slot = (slot + 1) & (slots - 1)) {
            const other = 3 * table[slot];
            if (other < 0) {
                map[v] = table[slot] = size++;
                break;
            }
            if (bits[other] === bits[at] && bits[other + 1] === bits[at + 1] && bits[other + 2] === bits[at + 2]) {
                map[v] = table[slot];
                break;
            }
        }
    }
    const indices = new Uint32Array(corners.length);
    for (let i = 0; i < corners.length; ++i) {
        if (corners[i] >= count) throw new Fault(`web-ifc gave corner ${corners[i]} of ${count}`);
        indices[i] = map[corners[i]];
    }
    return {positions: kept.slice(0, 3 * size), indices};
}

/** Column after column, as web-ifc and the stream have them. */
export function point(m, x, y, z) {
    return [0, 1, 2].map((row) => m[row] * x + m[4 + row] * y + m[8 + row] * z + m[12 + row]);
}

/** Bounds in the world; throws a Fault where they are not finite or too far. */
export function boundsOf(pieces) {
    const min = [Infinity, Infinity, Infinity], max = [-Infinity, -Infinity, -Infinity];
    for (const {transform, positions} of pieces) {
        for (let i = 0; i < positions.length; i += 3) {
            const p = point(transform, positions[i], positions[i + 1], positions[i + 2]);
            for (let axis = 0; axis < 3; ++axis) {
                if (!(Math.abs(p[axis]) < kFarthest)) throw new Fault('a position is not finite, or beyond 10^9 m');
                if (p[axis] < min[axis]) min[axis] = p[axis];
                if (p[axis] > max[axis]) max[axis] = p[axis];
            }
        }
    }
    return {min, max};
}

/** The inverse of the 3 x 3 part, row after row; null: there is none. */
function inverse(m) {
    const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    const x = [m[0], m[1], m[2]], y = [m[4], m[5], m[6]], z = [m[8], m[9], m[10]];
    const rows = [cross(y, z), cross(z, x), cross(x, y)];
    const det = x[0] * rows[0][0] + x[1] * rows[0][1] + x[2] * rows[0][2];
    if (!(Math.abs(det) > 0) || !Number.isFinite(1 / det)) return null;
    return rows.map((row) => row.map((value) => value / det));
}

/** What places a piece in the frame of the first one. */
function relative(first, m) {
    const back = inverse(first);
    if (!back) return null;
    const to = (x, y, z) => back.map((row) => row[0] * x + row[1] * y + row[2] * z);
    return [...to(m[0], m[1], m[2]), 0, ...to(m[4], m[5], m[6]), 0, ...to(m[8], m[9], m[10]), 0,
        ...to(m[12] - first[12], m[13] - first[13], m[14] - first[14]), 1];
}

/** Makes meshes of pieces, and knows those that it has made. */
export class Meshes {
    constructor(stream) {
        this.stream = stream;
        this.known = new Map();
    }

    /**
     * Sends the mesh of a product, unless the same was sent before.
     * @param pieces  [{transform, positions, indices, material}], one at least; finite
     * @return {mesh: its index, transform: to the world}
     */
    send(name, pieces) {
        // The positions of the first piece stay as they are; what places it, in doubles, places the object.
        let transform = pieces[0].transform, places = pieces.map((piece) => relative(transform, piece.transform));
        if (pieces.length > 1 && places.includes(null)) {
            transform = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, ...transform.slice(12)];
            places = pieces.map((piece) => relative(transform, piece.transform));
        }
        const hash = crypto.createHash('sha1');
        pieces.forEach((piece, i) => {
            if (i > 0 || transform !== pieces[0].transform) hash.update(places[i].map((x) => Math.round(x * kFine)).join(' '));
            hash.update(`${piece.material} ${piece.indices.length};`).update(piece.positions).update(piece.indices);
        });
        const key = hash.digest('latin1');
        let mesh = this.known.get(key);
        if (mesh === undefined) this.known.set(key, mesh = this.sendNew(name, pieces, transform, places));
        return {mesh, transform};
    }

    sendNew(name, pieces, transform, places) {
        const size = (of) => pieces.reduce((sum, piece) => sum + piece[of].length, 0);
        const positions = new Float32Array(size('positions')), indices = new Uint32Array(size('indices')), parts = [];
        let at = 0, corner = 0;
        pieces.forEach((piece, i) => {
            const base = at / 3, same = i === 0 && transform === piece.transform;
            for (let p = 0; p < piece.positions.length; p += 3) {
                const [x, y, z] = [piece.positions[p], piece.positions[p + 1], piece.positions[p + 2]];
                positions.set(same ? [x, y, z] : point(places[i], x, y, z), at);
                at += 3;
            }
            parts.push({first: corner / 3, count: piece.indices.length / 3, material: piece.material});
            for (const index of piece.indices) indices[corner++] = base + index;
        });
        const all = weld(positions, 3, indices);
        return this.stream.mesh(name, parts, all.positions, all.indices);
    }
}
