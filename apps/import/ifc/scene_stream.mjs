// Writes a scene as the stream of bytes that sightline/tools/import/foreign/scene_stream.h describes.
// SPDX-License-Identifier: MIT
import fs from 'node:fs';
import os from 'node:os';

const kProgress = 1, kNote = 2, kMaterial = 3, kNode = 4, kMesh = 5, kObject = 6, kFault = 8, kEnd = 9, kRoom = 10, kPart = 11;
const kMaterials = 0, kNodes = 1, kMeshes = 2, kObjects = 3, kRooms = 5;
const kLongestText = 1 << 16; // [bytes]
const kBlock = 1 << 16;
const kLittle = os.endianness() === 'LE';

export const kNoNode = 0xffffffff;
export const kOpaque = 0, kMask = 1, kBlend = 2;

export class SceneStream {
    constructor(file) {
        this.file = file;
        this.block = Buffer.alloc(kBlock);
        this.view = new DataView(this.block.buffer, this.block.byteOffset, kBlock);
        this.used = 0;
        this.counts = [0, 0, 0, 0, 0, 0];
        this.raw(Buffer.from('sightline scene\x02', 'latin1'));
    }

    progress(done, total) {
        this.head(kProgress, 16);
        this.u64(done);
        this.u64(total);
        this.flush();
    }

    note(text) {
        this.onlyText(kNote, text);
    }

    /** What is being read from here on, for the line that tells of a crash. */
    part(text) {
        this.onlyText(kPart, text);
        this.flush();
    }

    fault(text) {
        this.onlyText(kFault, text);
        this.flush();
    }

    /** @return its index */
    material({name, colour, mode}) {
        const text = bytesOf(name);
        this.head(kMaterial, 16 + 4 + 3 + 4 + text.length);
        for (const c of colour) this.f32(c);
        this.f32(0.5);
        this.u8(mode);
        this.u8(1); // both sides
        this.u8(0);
        this.text(text);
        return this.counts[kMaterials]++;
    }

    node(name, parent) {
        const text = bytesOf(name);
        this.head(kNode, 4 + 4 + text.length);
        this.u32(parent);
        this.text(text);
        return this.counts[kNodes]++;
    }

    /**
     * @param parts      [{first, count, material}] in triangles
     * @param positions  Float32Array, three a position
     * @param indices    Uint32Array, three a triangle
     */
    mesh(name, parts, positions, indices) {
        const text = bytesOf(name);
        this.head(kMesh, 3 * 8 + 1 + 48 + 4 + text.length + 12 * parts.length + positions.byteLength + indices.byteLength);
        this.u64(positions.length / 3);
        this.u64(indices.length / 3);
        this.u64(parts.length);
        this.u8(0);
        for (let i = 0; i < 6; ++i) this.f64(0);
        this.text(text);
        for (const {first, count, material} of parts) {
            this.u32(first);
            this.u32(count);
            this.u32(material);
        }
        this.raw(positions);
        this.raw(indices);
        return this.counts[kMeshes]++;
    }

    /** @param transform  16 numbers, column after column */
    object(name, mesh, node, transform) {
        const text = bytesOf(name);
        this.head(kObject, 9 + 128 + 4 + text.length);
        this.u32(mesh);
        this.u32(node);
        this.u8(0);  // it stands still
        for (const x of transform) this.f64(x);
        this.text(text);
        return this.counts[kObjects]++;
    }

    /** @param min  null: the room has no shape */
    room(node, min, max) {
        this.head(kRoom, 4 + 48);
        this.u32(node);
        for (const x of min ?? [Infinity, Infinity, Infinity]) this.f64(x);
        for (const x of max ?? [-Infinity, -Infinity, -Infinity]) this.f64(x);
        return this.counts[kRooms]++;
    }

    end() {
        this.head(kEnd, 8 * this.counts.length);
        for (const count of this.counts) this.u64(count);
        this.flush();
    }

    onlyText(kind, words) {
        const text = bytesOf(words);
        this.head(kind, 4 + text.length);
        this.text(text);
    }

    head(kind, size) {
        this.u32(kind);
        this.u64(size);
    }

    text(bytes) {
        this.u32(bytes.length);
        this.raw(bytes);
    }

    room_for(size) {
        if (this.used + size > kBlock) this.flush();
        const at = this.used;
        this.used += size;
        return at;
    }

    u8(x) {
        this.view.setUint8(this.room_for(1), x);
    }
    u32(x) {
        this.view.setUint32(this.room_for(4), x, kLittle);
    }
    u64(x) {
        this.view.setBigUint64(this.room_for(8), BigInt(x), kLittle);
    }
    f32(x) {
        this.view.setFloat32(this.room_for(4), x, kLittle);
    }
    f64(x) {
        this.view.setFloat64(this.room_for(8), x, kLittle);
    }

    raw(array) {
        const bytes = new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
        if (bytes.length > kBlock - this.used) this.flush();
        if (bytes.length > kBlock) return this.writeOut(bytes);
        this.block.set(bytes, this.used);
        this.used += bytes.length;
    }

    flush() {
        this.writeOut(this.block.subarray(0, this.used));
        this.used = 0;
    }

    writeOut(bytes) {
        for (let at = 0; at < bytes.length;) {
            try {
                at += fs.writeSync(this.file, bytes, at);
            } catch (error) {
                if (error.code !== 'EAGAIN' && error.code !== 'EINTR') process.exit(1); // who asked has gone
            }
        }
    }
}

function bytesOf(text) {
    const bytes = Buffer.from(text, 'utf8');
    return bytes.length > kLongestText ? bytes.subarray(0, kLongestText) : bytes;
}
