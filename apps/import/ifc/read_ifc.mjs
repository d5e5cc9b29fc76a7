// Reads an IFC file with web-ifc and writes the scene to standard output; sightline-import starts it, under limits.
// SPDX-License-Identifier: MIT
//
// node read_ifc.mjs FILE SUFFIX    SUFFIX: ifc or ifczip
import fs from 'node:fs';
import {createRequire} from 'node:module';
import path from 'node:path';
import {fileURLToPath} from 'node:url';

import {unpackIfc} from './ifczip.mjs';
import {boundsOf, Meshes, weld} from './meshes.mjs';
import {kBlend, kNoNode, kOpaque, SceneStream} from './scene_stream.mjs';
import {Fault, Ref, Step} from './step.mjs';
import {keepBodies, Surfaces, sweepWhole} from './surfaces.mjs';

const kOutOfMemory = 12; // the exit code that sightline-import has for it
const kMostRestarts = 20, kMostNames = 3;
const kSchemas = /^IFC(2X3|4|4X1|4X2|4X3)(_|$)/;

const kCut = /^IFC(OPENING.*|VOIDINGFEATURE|FEATUREELEMENTSUBTRACTION|EARTHWORKSCUT)$/;
const kRoom = /^IFC(SPACE|SPATIALZONE|EXTERNALSPATIALELEMENT)$/;
const kNotDrawn = /^IFC(ANNOTATION|GRID|VIRTUALELEMENT|ALIGNMENT.*|REFERENT|LINEARELEMENT|POSITIONINGELEMENT|LINEARPOSITIONINGELEMENT|STRUCTURAL.*|.*PORT)$/;
const kPlaces = /^IFC(PROJECT|SITE|BUILDING|BUILDINGSTOREY|BRIDGE.*|FACILITY.*|MARINEFACILITY|MARINEPART|RAILWAY.*|ROAD.*|TUNNEL.*)$/;

const stream = new SceneStream(1);
const heard = [];
for (const word of ['log', 'info', 'debug', 'warn', 'error'])
    console[word] = (...words) => {
        if (!words.join(' ').includes('GetColor')) heard.push(words); // nothing is lost by a colour
    };

/** web-ifc with the file open in it; after a fault in it, a new one. */
class Library {
    constructor(folder, bytes) {
        this.folder = folder + path.sep;
        this.bytes = bytes;
        this.web = createRequire(import.meta.url)(path.join(folder, 'web-ifc-api-node.js'));
    }

    async open() {
        this.api = new this.web.IfcAPI();
        this.api.SetWasmPath(this.folder, true);
        await this.api.Init(undefined, true);
        this.model = this.api.OpenModel(this.bytes, {COORDINATE_TO_ORIGIN: false});
    }

    /** The name of a type as people write it, "IfcWall"; empty: it knows none of this name. */
    nameOf(type) {
        const code = this.api.GetTypeCodeFromName(type), name = this.api.GetNameFromTypeCode(code);
        return /^Ifc\w+$/.test(name) ? name : '';
    }

    isProduct(type) {
        return this.api.IsIfcElement(this.api.GetTypeCodeFromName(type));
    }

    /** Triangles of a product: [{item, colour, transform, positions, indices}]. */
    piecesOf(id) {
        const out = [];
        let fault = null;
        this.api.StreamMeshes(this.model, [id], (mesh) => {
            try {
                for (let i = 0; i < mesh.geometries.size(); ++i) this.addPiece(mesh.geometries.get(i), out);
                mesh.geometries.delete();
            } catch (error) {
                fault = error; // not through the library, which would not know it
            }
        });
        if (fault) throw fault;
        return out;
    }

    addPiece({geometryExpressID, color, flatTransformation}, out) {
        const geometry = this.api.GetGeometry(this.model, geometryExpressID);
        const vertices = this.api.GetVertexArray(geometry.GetVertexData(), geometry.GetVertexDataSize());
        const corners = this.api.GetIndexArray(geometry.GetIndexData(), geometry.GetIndexDataSize());
        const piece = {item: geometryExpressID, colour: [color.x, color.y, color.z, color.w], transform: [...flatTransformation]};
        if (corners.length > 0) out.push({...piece, ...weld(vertices, 6, corners)});
        geometry.delete();
    }
}

/** A count by words, told as "3 IfcSpace, 1 IfcGrid". */
class Counts {
    constructor() {
        this.of = new Map();
    }
    add(word) {
        this.of.set(word, (this.of.get(word) ?? 0) + 1);
    }
    get empty() {
        return this.of.size === 0;
    }
    toString() {
        const all = [...this.of].sort((a, b) => b[1] - a[1]).map(([word, count]) => `${count} ${word}`);
        return all.length > kMostNames + 1 ? `${all.slice(0, kMostNames).join(', ')} and others` : all.join(', ');
    }
}

const someOf = (names) => `${names.length} (${names.slice(0, kMostNames).join(', ')}${names.length > kMostNames ? ', ...' : ''})`;

const isMemory = (error) => !(error instanceof Fault) && /out of memory|\bOOM\b|allocation failed|enlarge memory/i.test(String(error?.message ?? error));

class Reader {
    constructor(step, library, loose) {
        this.step = step;
        this.library = library;
        this.loose = loose;
        this.surfaces = new Surfaces(step, loose);
        this.meshes = new Meshes(stream);
        this.materials = new Map();
        this.nodes = new Map();
        this.names = new Map();
        this.parents = this.readParents();
        this.read = 0;
        this.cut = new Counts();
        this.rooms = new Counts();
        this.not_drawn = new Counts();
        this.unknown = new Counts();
        this.without = []; ///< products without triangles, by name
        this.in_part = [];
        this.failed = [];
        this.restarts = 0;
    }

    /** What a thing stands in: by aggregation, containment, nesting; a door by the wall that its opening is cut of. */
    readParents() {
        const {step} = this, out = new Map();
        const take = (type, above, below) => {
            for (const id of step.ofType(type)) {
                const attributes = step.attributes(id), parent = Step.refs(attributes[above])[0];
                for (const child of Step.refs(attributes[below])) if (parent !== undefined && !out.has(child)) out.set(child, parent);
            }
        };
        take('IFCRELAGGREGATES', 4, 5);
        take('IFCRELCONTAINEDINSPATIALSTRUCTURE', 5, 4);
        take('IFCRELNESTS', 4, 5);
        take('IFCRELFILLSELEMENT', 4, 5);
        take('IFCRELVOIDSELEMENT', 4, 5);
        return out;
    }

    nameOfType(type) {
        let name = this.names.get(type);
        if (name === undefined) this.names.set(type, name = this.library.nameOf(type));
        return name;
    }

    label(id) {
        const type = this.nameOfType(this.step.type(id)) || this.step.type(id);
        const [global, , name] = this.step.attributes(id);
        const words = typeof name === 'string' && name.trim() !== '' ? name.trim() : '';
        if (kPlaces.test(this.step.type(id))) return words || type;
        return `${type} ${words || (typeof global === 'string' && global) || `#${id}`}`;
    }

    inWords(id) {
        const type = this.nameOfType(this.step.type(id)) || this.step.type(id), name = this.step.attributes(id)[2];
        return `${type} #${id}${typeof name === 'string' && name ? ` '${name.slice(0, 40)}'` : ''}`;
    }

    /** The node of a thing, which is sent behind those above it. */
    nodeOf(id) {
        const way = [], seen = new Set();
        let at = id;
        for (; at !== undefined && !this.nodes.has(at) && !seen.has(at); at = this.parents.get(at)) {
            seen.add(at);
            if (this.step.type(at) !== 'IFCPROJECT' && !kCut.test(this.step.type(at))) way.push(at);
        }
        let node = this.nodes.get(at) ?? kNoNode;
        while (way.length > 0) {
            const next = way.pop();
            node = stream.node(this.label(next), node);
            this.nodes.set(next, node);
        }
        return node;
    }

    materialOf(colour, clear) {
        const mode = clear || !(colour[3] >= 1) ? kBlend : kOpaque;
        const numbers = colour.map((c) => Math.min(1, Math.max(0, Number.isFinite(c) ? c : 1)));
        const key = `${mode} ${numbers.join(' ')}`;
        let material = this.materials.get(key);
        if (material === undefined) this.materials.set(key, material = stream.material({name: '', colour: numbers, mode}));
        return material;
    }

    /** All things with a shape, in the file's order: [id, type]. Counts those of types that web-ifc does not know. */
    products() {
        const {step} = this, out = [];
        for (const type of step.types) {
            const known = type !== '' && this.nameOfType(type) !== '';
            if (known && !this.library.isProduct(type)) continue;
            for (const id of step.ofType(type)) {
                if (!known) this.unknown.add(type || 'of several types');
                const shape = step.attributes(id)[6];
                if (known && shape instanceof Ref && step.has(shape.id)) out.push([id, type]);
            }
        }
        return out.sort((a, b) => a[0] - b[0]);
    }

    async readAll() {
        const products = this.products();
        let told = 0, done = 0;
        for (const [id, type] of products) {
            if (kCut.test(type)) this.cut.add(this.nameOfType(type));
            else if (kNotDrawn.test(type)) this.not_drawn.add(this.nameOfType(type));
            else await this.readOne(id, type);
            const step = Math.floor(++done / products.length * 100);
            if (step > told) stream.progress(told = step, 100);
        }
        this.tell(products.length);
    }

    async readOne(id, type) {
        stream.part(this.inWords(id));
        heard.length = 0;
        try {
            const pieces = this.library.piecesOf(id);
            if (kRoom.test(type)) return this.sendRoom(id, pieces);
            if (pieces.length === 0) return this.without.push(this.inWords(id));
            boundsOf(pieces);
            for (const piece of pieces) piece.material = this.materialOf(piece.colour, this.surfaces.clear(id, piece.item, type));
            const name = this.label(id), {mesh, transform} = this.meshes.send(name, pieces);
            stream.object(name, mesh, this.nodeOf(id), transform);
            ++this.read;
            if (heard.length > 0) this.in_part.push(this.inWords(id));
        } catch (error) {
            if (!(error instanceof Fault)) await this.restart(error, id);
            this.failed.push(this.inWords(id));
        }
    }

    sendRoom(id, pieces) {
        this.rooms.add(this.nameOfType(this.step.type(id)));
        const {min, max} = boundsOf(pieces);
        stream.room(this.nodeOf(id), pieces.length > 0 ? min : null, max);
    }

    /** After a fault in web-ifc nothing of it is believed. */
    async restart(error, id) {
        if (isMemory(error)) throw error;
        if (++this.restarts > kMostRestarts)
            throw new Fault(`web-ifc fails on more than ${kMostRestarts} products, the last of them ${this.inWords(id)}; export the file as glTF`);
        await this.library.open();
    }

    /** One line: what was read, and what not and why. */
    tell(products) {
        const words = [`read ${this.read} of ${products} products with a shape`];
        if (!this.cut.empty) words.push(`cut out of others: ${this.cut}`);
        if (!this.rooms.empty) words.push(`rooms, which hide nothing: ${this.rooms}`);
        if (!this.not_drawn.empty) words.push(`not drawn: ${this.not_drawn}`);
        if (this.without.length > 0) words.push(`without triangles: ${someOf(this.without)}`);
        if (this.in_part.length > 0) words.push(`perhaps read in part: ${someOf(this.in_part)}`);
        if (this.loose.size > 0) words.push(`swept along their whole curves, and so hiding nothing: ${this.loose.size} solids`);
        if (this.failed.length > 0) words.push(`could not be read: ${someOf(this.failed)}`);
        if (!this.unknown.empty) words.push(`of types that are not known: ${this.unknown}`);
        const lost = this.step.lost();
        if (lost > 0) words.push(`references that lead nowhere: ${lost}`);
        if (this.step.twice > 0) words.push(`numbers given twice: ${this.step.twice}`);
        const line = words.join('; ');
        if (products === 0) throw new Fault('draws nothing: no product in it has a shape');
        if (this.read === 0) throw new Fault(`draws nothing: ${line}`);
        stream.note(line);
    }
}

/** Unit and schema, of which web-ifc would make up something. */
function checkProject(step) {
    if (!kSchemas.test(step.schema)) throw new Fault(`${step.schema ? `is of the schema ${step.schema}, which is not read` : 'names no schema'}: export it as IFC2x3, IFC4 or IFC4x3`);
    const projects = step.ofType('IFCPROJECT');
    if (projects.length > 1) throw new Fault(`holds ${projects.length} IfcProject, where one is allowed: export them one by one`);
    const units = projects.length === 1 ? step.attributes(projects[0])[8] : null;
    const length = Step.refs(units instanceof Ref ? step.attributes(units.id)[0] : null).some((unit) => step.attributes(unit)[1]?.word === 'LENGTHUNIT');
    if (!length) stream.note('tells no unit of length: metres are taken (--unit)');
}

/** Geometry whose indices lead out of its points, where web-ifc would take what lies behind them, or count otherwise. */
function checkIndices(step) {
    const pointsOf = new Map();
    const count = (list) => {
        if (!pointsOf.has(list)) pointsOf.set(list, (step.attributes(list)[0] ?? []).length);
        return pointsOf.get(list);
    };
    const check = (id, points, indices, most) => {
        for (const index of indices.flat(3))
            if (!(index >= 1 && index <= most)) throw new Fault(`#${id} (${step.type(id)}) has no point ${index}`);
    };
    for (const type of ['IFCTRIANGULATEDFACESET', 'IFCTRIANGULATEDIRREGULARNETWORK', 'IFCPOLYGONALFACESET', 'IFCINDEXEDPOLYCURVE'])
        for (const id of step.ofType(type)) {
            const attributes = step.attributes(id), points = attributes[0];
            if (!(points instanceof Ref) || !step.has(points.id)) throw new Fault(`#${id} (${type}) refers to points that are not there`);
            const most = count(points.id), renumbered = {IFCPOLYGONALFACESET: 3, IFCINDEXEDPOLYCURVE: 99}[type] ?? 4;
            if (attributes[renumbered]?.some((point, i) => point !== i + 1))
                throw new Fault(`#${id} (${type}) numbers its points anew (PnIndex), which web-ifc does not follow: export it without, or as glTF`);
            if (type === 'IFCINDEXEDPOLYCURVE') {
                for (const segment of attributes[1] ?? []) check(id, points.id, segment.args ?? [], most);
            } else if (type === 'IFCPOLYGONALFACESET') {
                for (const face of Step.refs(attributes[2])) check(id, points.id, step.attributes(face).filter(Array.isArray), most);
            } else check(id, points.id, attributes[3] ?? [], most);
        }
}

async function main(file, suffix) {
    const folder = path.join(path.dirname(fileURLToPath(import.meta.url)), 'web-ifc');
    let bytes;
    try {
        bytes = fs.readFileSync(file);
    } catch (error) {
        throw error.code ? new Fault(`cannot be read (${error.code})`) : error;
    }
    if (suffix === 'ifczip') bytes = unpackIfc(bytes);
    const step = new Step(bytes);
    checkProject(step);
    checkIndices(step);
    keepBodies(step);
    const loose = sweepWhole(step);
    const library = new Library(folder, bytes);
    await library.open();
    await new Reader(step, library, loose).readAll();
    stream.end();
}

main(process.argv[2], process.argv[3]).catch((error) => {
    if (isMemory(error)) process.exit(kOutOfMemory);
    stream.fault(error instanceof Fault ? error.message : `web-ifc fails on it (${String(error?.message ?? error).slice(0, 120)}): export it as glTF`);
    process.exit(0);
});
