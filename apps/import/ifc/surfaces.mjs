// Which representations of an IFC product are its body, and what of it may be seen through.
// SPDX-License-Identifier: MIT
//
// buildingSMART. IFC 4.3, IfcShapeRepresentation, IfcSurfaceStyle, IfcPresentationLayerWithStyle.
import {Enumeration, Ref, Step, Typed} from './step.mjs';

const kNoBody = new Set(['ANNOTATION', 'AXIS', 'BOX', 'CLEARANCE', 'COG', 'FOOTPRINT', 'LIGHTING', 'PLAN', 'PROFILE',
    'REFERENCE', 'SURVEYPOINTS']);

/** What is walked from a product to the items that have styles. */
const kWalked = /^IFC(PRODUCTDEFINITIONSHAPE|PRODUCTREPRESENTATION|SHAPEREPRESENTATION|TOPOLOGYREPRESENTATION|MAPPEDITEM|REPRESENTATIONMAP|BOOLEAN.*RESULT|CSGSOLID|FACETEDBREP.*|ADVANCEDBREP.*|SHELLBASEDSURFACEMODEL|FACEBASEDSURFACEMODEL|GEOMETRICSET)$/;

const upper = (value) => typeof value === 'string' ? value.toUpperCase() : '';

/**
 * Takes out of the file, in place, what web-ifc would draw over a product's body: its box, its axis, the room that it needs.
 * Where a product has a representation 'Body', that is kept, in the first context that has one; else all that may be a body.
 */
export function keepBodies(step) {
    for (const id of [...step.ofType('IFCPRODUCTDEFINITIONSHAPE'), ...step.ofType('IFCPRODUCTREPRESENTATION')]) {
        const shapes = Step.refs(step.attributes(id)[2]).map((shape) => {
            const [context, name, type] = step.attributes(shape);
            return {shape, context: context instanceof Ref ? context.id : 0, name: upper(name), type: upper(type)};
        });
        const solid = shapes.filter((s) => s.type !== 'BOUNDINGBOX' && !kNoBody.has(s.name));
        const body = solid.find((s) => s.name === 'BODY');
        const kept = new Set((body ? solid.filter((s) => s.name === 'BODY' && s.context === body.context) : solid).map((s) => s.shape));
        for (const {shape} of shapes) if (!kept.has(shape)) step.blankReference(id, shape);
    }
}

/**
 * Lets disks be swept along the whole of a curve where web-ifc cannot find the part that the file means, which it would
 * leave out: bars of reinforcement, of which exporters write the whole curve's length there. In place.
 * @return the solids, of which less may be there than is drawn
 */
export function sweepWhole(step) {
    const out = new Set();
    for (const id of [...step.ofType('IFCSWEPTDISKSOLID'), ...step.ofType('IFCSWEPTDISKSOLIDPOLYGONAL')]) {
        const [curve, , , begin, end] = step.attributes(id);
        if (!(curve instanceof Ref) || (typeof begin !== 'number' && typeof end !== 'number')) continue;
        const points = step.type(curve.id) === 'IFCPOLYLINE' ? (step.attributes(curve.id)[0] ?? []).length : 0;
        const whole = points > 0 && (begin ?? 0) === 0 && (end ?? points - 1) === points - 1;
        if (points > 0 && !whole && (begin ?? 0) >= 0 && (end ?? 0) < points - 1) continue; // web-ifc finds this part
        for (const number of [3, 4]) step.blankAttribute(id, number);
        if (!whole) out.add(id);
    }
    return out;
}

/** Surfaces that may let light through, or may not be drawn: these hide nothing. */
export class Surfaces {
    /** @param loose  items that may be less than is drawn */
    constructor(step, loose) {
        this.step = step;
        this.item_styles = new Map(); ///< item -> it may be seen through
        this.material_styles = new Map(); ///< material -> the same
        this.product_materials = new Map(); ///< product or its type -> materials
        this.reached = new Map();
        this.readStyles();
        this.readLayers();
        this.readMaterials();
        for (const item of loose) this.mark(item, true);
        this.any = [...this.item_styles.values(), ...this.material_styles.values()].includes(true);
    }

    /**
     * Whether what web-ifc gives as item `item` of a product may be seen through, whatever colour it found first.
     * An item's own styles decide; without, those of all that the product reaches, and of its materials.
     */
    clear(product, item, type) {
        const window = type.startsWith('IFCWINDOW');
        if (!this.any && !window) return false;
        const own = this.item_styles.get(item);
        if (own) return true;
        let styled = own === false;
        for (const reached of this.reachedFrom(this.representation(product))) {
            const style = this.item_styles.get(reached);
            if (style && (own === undefined || this.step.type(reached) === 'IFCMAPPEDITEM')) return true;
            styled ||= style === false;
        }
        if (own === false) return false;
        for (const material of this.product_materials.get(product) ?? []) {
            const style = this.material_styles.get(material);
            if (style) return true;
            styled ||= style !== undefined;
        }
        return !styled && window; // no style tells of its panes
    }

    representation(product) {
        const shape = this.step.attributes(product)[6];
        return shape instanceof Ref ? shape.id : 0;
    }

    /** Items that a representation shows, and those that they are made of. */
    reachedFrom(id) {
        const known = this.reached.get(id);
        if (known) return known;
        const out = new Set(), todo = [id];
        while (todo.length > 0) {
            const next = todo.pop();
            if (out.has(next)) continue;
            out.add(next);
            if (kWalked.test(this.step.type(next))) todo.push(...Step.refs(this.step.attributes(next)));
        }
        this.reached.set(id, out);
        return out;
    }

    readStyles() {
        const {step} = this;
        for (const id of step.ofType('IFCSTYLEDITEM')) {
            const [item, styles] = step.attributes(id);
            if (item instanceof Ref) this.mark(item.id, this.styleIsClear(styles));
        }
        for (const id of step.ofType('IFCINDEXEDCOLOURMAP')) {
            const [item, opacity] = step.attributes(id);
            const number = opacity instanceof Typed ? opacity.args[0] : opacity;
            if (item instanceof Ref) this.mark(item.id, number !== null && !(number >= 1));
        }
    }

    mark(item, clear) {
        this.item_styles.set(item, this.item_styles.get(item) || clear);
    }

    /** A layer that is off or frozen, or has styles to see through. */
    readLayers() {
        const is = (value, word) => value instanceof Enumeration && value.word === word;
        for (const id of this.step.ofType('IFCPRESENTATIONLAYERWITHSTYLE')) {
            const [, , items, , on, frozen, , styles] = this.step.attributes(id);
            if (!is(on, 'F') && !is(frozen, 'T') && !this.styleIsClear(styles)) continue;
            for (const item of Step.refs(items))
                for (const reached of this.reachedFrom(item)) this.mark(reached, true);
        }
        this.reached.clear();
    }

    styleIsClear(value) {
        return Step.refs(value).some((id) => {
            const attributes = this.step.attributes(id);
            switch (this.step.type(id)) {
                case 'IFCPRESENTATIONSTYLEASSIGNMENT': return this.styleIsClear(attributes[0]);
                case 'IFCSTYLEDITEM': return this.styleIsClear(attributes[1]); // of older files: styles of styles
                case 'IFCSTYLEDREPRESENTATION': return this.styleIsClear(attributes[3]);
                case 'IFCSURFACESTYLE': return this.styleIsClear(attributes[2]);
                case 'IFCSURFACESTYLESHADING':
                case 'IFCSURFACESTYLERENDERING': {
                    const share = attributes[1] instanceof Typed ? attributes[1].args[0] : attributes[1] ?? 0;
                    return share !== 0;
                }
                case 'IFCSURFACESTYLEREFRACTION': return true;
                case 'IFCSURFACESTYLEWITHTEXTURES': return Step.refs(attributes[0]).some((texture) => !this.textureIsOpaque(texture));
                default: return false;
            }
        });
    }

    /** No picture is looked at: what may have an alpha channel may be clear. */
    textureIsOpaque(id) {
        const name = upper(this.step.attributes(id).at(-1));
        return this.step.type(id) === 'IFCIMAGETEXTURE' && /\.(JPE?G|BMP)$/.test(name);
    }

    readMaterials() {
        const {step} = this;
        for (const id of step.ofType('IFCMATERIALDEFINITIONREPRESENTATION')) {
            const [, , styles, material] = step.attributes(id);
            const clear = Step.refs(styles).some((style) => Step.refs(step.attributes(style)[3]).some((item) => this.styleIsClear(step.attributes(item)[1])));
            if (material instanceof Ref) this.material_styles.set(material.id, this.material_styles.get(material.id) || clear);
        }
        if (this.material_styles.size === 0) return;
        const of = new Map();
        for (const id of step.ofType('IFCRELASSOCIATESMATERIAL')) {
            const [, , , , products, material] = step.attributes(id);
            for (const product of Step.refs(products)) of.set(product, this.materialsIn(material));
        }
        for (const id of step.ofType('IFCRELDEFINESBYTYPE')) {
            const [, , , , products, type] = step.attributes(id);
            const materials = type instanceof Ref ? of.get(type.id) : undefined;
            if (materials) for (const product of Step.refs(products)) this.product_materials.set(product, materials);
        }
        for (const [product, materials] of of) this.product_materials.set(product, materials);
    }

    /** Materials, and what lists, layers, profiles and constituents are made of. */
    materialsIn(value) {
        const out = [], todo = Step.refs(value), seen = new Set();
        while (todo.length > 0) {
            const id = todo.pop();
            if (seen.has(id) || !this.step.type(id).startsWith('IFCMATERIAL')) continue;
            seen.add(id);
            out.push(id);
            todo.push(...Step.refs(this.step.attributes(id)));
        }
        return out;
    }
}
