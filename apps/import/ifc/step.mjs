// The text of an IFC file (STEP, ISO 10303-21): checked, put into the form that web-ifc reads, and taken apart by attributes.
// SPDX-License-Identifier: MIT
//
// web-ifc believes what it reads: a string or a comment without an end has it read on for ever, and what lacks a bracket
// becomes another statement in silence. So every byte is looked at here first.

/** Why there is no scene: one line without the file's name. */
export class Fault extends Error {}

/** A reference `#12` among attributes. */
export class Ref {
    constructor(id) {
        this.id = id;
    }
}

/** An attribute with its type, as `IFCLABEL('x')`. */
export class Typed {
    constructor(type, args) {
        this.type = type;
        this.args = args;
    }
}

/** An attribute `.TRUE.`, without its dots. */
export class Enumeration {
    constructor(word) {
        this.word = word;
    }
}

const kBlank = 0x20, kQuote = 0x27, kOpen = 0x28, kClose = 0x29, kStar = 0x2a, kMinus = 0x2d, kDot = 0x2e, kSlash = 0x2f;
const kSemicolon = 0x3b, kEquals = 0x3d, kHash = 0x23, kBackslash = 0x5c, kDouble = 0x22;
const kLongestString = 60000; // web-ifc counts the bytes of a string in 16 bits
const kLargestId = 0xfffffffe;

const isDigit = (c) => c >= 0x30 && c <= 0x39;
const isLetter = (c) => (c >= 0x41 && c <= 0x5a) || (c >= 0x61 && c <= 0x7a);
const isWord = (c) => isLetter(c) || isDigit(c) || c === 0x5f;
const isNumber = (c) => isDigit(c) || c === kDot || c === kMinus || c === 0x2b || c === 0x45 || c === 0x65;

/** Statements `#id = TYPE(...)` of a file, by their numbers. */
export class Step {
    /**
     * Blanks comments, writes types in capitals and shortens strings that are too long for web-ifc, all in place.
     * Throws a Fault that names the line if the text is not STEP or ends too early.
     */
    constructor(bytes) {
        this.bytes = bytes;
        this.types = []; ///< names of types, in capitals
        this.schema = '';
        this.twice = 0; ///< numbers that are given to more than one statement; the last one counts
        this.type_numbers = new Map();
        this.statements = new Map(); ///< id -> place in the three arrays
        this.type_of = [];
        this.begins = []; ///< where the bracket of the attributes opens
        this.ends = [];
        this.referred = new Set();
        this.read();
    }

    /** Ids of all statements of a type. */
    ofType(type) {
        const number = this.type_numbers.get(type);
        const out = [];
        if (number === undefined) return out;
        for (const [id, place] of this.statements) if (this.type_of[place] === number) out.push(id);
        return out;
    }

    has(id) {
        return this.statements.has(id);
    }

    type(id) {
        const place = this.statements.get(id);
        return place === undefined ? '' : this.types[this.type_of[place]];
    }

    /** The attributes of a statement: numbers, texts, null for `$` and `*`, Ref, Enumeration, Typed, or arrays of these. */
    attributes(id) {
        const place = this.statements.get(id);
        if (place === undefined) return [];
        return new Attributes(this.bytes, this.begins[place], this.ends[place]).read();
    }

    /** Blanks each reference to `lost` among the attributes of a statement. */
    blankReference(id, lost) {
        const place = this.statements.get(id), word = `#${lost}`, bytes = this.bytes;
        for (let at = this.begins[place]; (at = bytes.indexOf(word, at, 'latin1')) >= 0 && at < this.ends[place]; at += word.length)
            if (!isDigit(bytes[at + word.length])) bytes.fill(kBlank, at, at + word.length);
    }

    /** Makes an attribute, counted from 0, absent. */
    blankAttribute(id, number) {
        const place = this.statements.get(id);
        const [from, to] = new Attributes(this.bytes, this.begins[place], this.ends[place]).span(number);
        if (from >= to) return;
        this.bytes.fill(kBlank, from, to);
        this.bytes[from] = 0x24; // $
    }

    /** References that an attribute holds, itself or in lists. */
    static refs(value, out = []) {
        if (value instanceof Ref) out.push(value.id);
        else if (Array.isArray(value)) for (const v of value) Step.refs(v, out);
        else if (value instanceof Typed) Step.refs(value.args, out);
        return out;
    }

    /** How many references lead nowhere. */
    lost() {
        let out = 0;
        for (const id of this.referred) if (!this.statements.has(id)) ++out;
        return out;
    }

    line(at) {
        let line = 1;
        for (let i = 0; i < at && i < this.bytes.length; ++i) if (this.bytes[i] === 0x0a) ++line;
        return line;
    }

    fail(at, what) {
        const text = this.bytes.toString('latin1', at, Math.min(at + 40, this.bytes.length)).replace(/[^ -~]+/g, ' ');
        throw new Fault(`line ${this.line(at)}: ${what}: ${text}`);
    }

    read() {
        const bytes = this.bytes, size = bytes.length;
        let at = 0, section = '', ended = false;
        if (size > 2 && bytes[0] === 0xef && bytes[1] === 0xbb && bytes[2] === 0xbf) bytes.fill(kBlank, 0, 3);
        while ((at = this.skipBlank(at)) < size) {
            const begin = at;
            const statement = this.statement(at);
            at = statement.end + 1;
            if (bytes[begin] === kHash) {
                if (section !== 'DATA') this.fail(begin, 'a statement stands outside of DATA');
                this.add(begin, statement);
                continue;
            }
            const word = bytes.toString('latin1', begin, Math.min(statement.end, begin + 24)).trim().toUpperCase();
            if (word.startsWith('END-ISO-10303-21')) {
                ended = true;
                break;
            }
            if (word === 'HEADER' || word === 'ENDSEC') section = word;
            else if (/^DATA\s*(\(|$)/.test(word)) section = 'DATA';
            else if (word.startsWith('FILE_SCHEMA')) this.readSchema(begin, statement.end);
            else if (section === 'DATA') this.fail(begin, 'this is no statement of STEP');
        }
        if (!ended) throw new Fault(`ends too early: END-ISO-10303-21 is missing behind line ${this.line(size)}; get the whole file`);
    }

    readSchema(begin, end) {
        const name = /'([^']*)'/.exec(this.bytes.toString('latin1', begin, end));
        if (name) this.schema = name[1].toUpperCase();
    }

    /** Over blanks and comments, which become blanks. */
    skipBlank(at) {
        const bytes = this.bytes, size = bytes.length;
        while (at < size) {
            const c = bytes[at];
            if (c <= kBlank) ++at;
            else if (c === kSlash && bytes[at + 1] === kStar) at = this.blankComment(at);
            else break;
        }
        return at;
    }

    blankComment(at) {
        const end = this.bytes.indexOf('*/', at + 2, 'latin1');
        if (end < 0) this.fail(at, 'a comment has no end');
        for (let i = at; i < end + 2; ++i) if (this.bytes[i] !== 0x0a) this.bytes[i] = kBlank;
        return end + 2;
    }

    /** From `at` to the semicolon: where the outermost bracket opens and closes. Blanks comments. */
    statement(begin) {
        const bytes = this.bytes, size = bytes.length;
        let at = begin, depth = 0, open = -1, close = -1;
        while (at < size) {
            const c = bytes[at];
            if (c === kSemicolon) {
                if (depth > 0) this.fail(begin, 'a bracket is not closed');
                return {open, close, end: at};
            }
            if (c > kBlank && close >= 0 && depth === 0 && c !== kSlash && c !== kClose) this.fail(begin, 'a semicolon is missing behind');
            if (c === kQuote) at = this.string(at);
            else if (c === kSlash && bytes[at + 1] === kStar) at = this.blankComment(at);
            else if (c === kHash) at = this.reference(at, at === begin);
            else if (isDigit(c)) while (isNumber(bytes[at])) ++at;
            else if (c === kDot) at = this.enumeration(at);
            else if (isLetter(c)) at = this.word(at);
            else {
                if (c === kDouble && (at = bytes.indexOf(kDouble, at + 1)) < 0) this.fail(begin, 'a binary has no end');
                if (c === kOpen && depth++ === 0) open = at;
                if (c === kClose && --depth === 0) close = at;
                if (depth < 0) this.fail(begin, 'a bracket closes that none has opened');
                ++at;
            }
        }
        this.fail(begin, 'the file ends inside of a statement; get the whole file');
    }

    /** Behind a string. `\S\'` is a letter, '' a quote. */
    string(begin) {
        const bytes = this.bytes, size = bytes.length;
        let at = begin + 1;
        for (;; ++at) {
            if (at >= size) this.fail(begin, 'a text has no end');
            if (bytes[at] !== kQuote) continue;
            const escaped = bytes[at - 1] === kBackslash && (bytes[at - 2] | 0x20) === 0x73 && bytes[at - 3] === kBackslash;
            if (escaped && at - 3 > begin) continue;
            if (bytes[at + 1] !== kQuote) break;
            ++at;
        }
        if (at - begin > kLongestString) {
            bytes.fill(kBlank, begin + 1, at + 1);
            bytes[begin + 1] = kQuote;
        }
        return at + 1;
    }

    reference(begin, defines) {
        const bytes = this.bytes;
        let id = 0, at = begin + 1;
        for (; isDigit(bytes[at]); ++at) id = id * 10 + (bytes[at] - 0x30);
        if (at === begin + 1 || id === 0 || id > kLargestId) this.fail(begin, 'this is no number of a statement');
        if (!defines) this.referred.add(id);
        return at;
    }

    enumeration(begin) {
        const at = this.word(begin + 1);
        if (at === begin + 1 || this.bytes[at] !== kDot) this.fail(begin, 'this is neither a number nor a word between dots');
        return at + 1;
    }

    word(at) {
        const bytes = this.bytes;
        for (; isWord(bytes[at]) || bytes[at] === kMinus; ++at) if (bytes[at] >= 0x61 && bytes[at] <= 0x7a) bytes[at] -= 0x20;
        return at;
    }

    /** Takes down a statement of DATA. */
    add(begin, {open, close, end}) {
        const bytes = this.bytes;
        let at = begin + 1, id = 0;
        for (; isDigit(bytes[at]); ++at) id = id * 10 + (bytes[at] - 0x30);
        at = this.skipBlank(at);
        if (bytes[at] !== kEquals || open < 0) this.fail(begin, 'this is no statement of STEP');
        at = this.skipBlank(at + 1);
        let type = '';
        if (at !== open) { // otherwise it has several types at once, which nothing that is read here has
            const from = at;
            while (isWord(bytes[at])) ++at;
            type = bytes.toString('latin1', from, at);
            if (type === '' || this.skipBlank(at) !== open) this.fail(begin, 'this is no statement of STEP');
        }
        let number = this.type_numbers.get(type);
        if (number === undefined) {
            number = this.types.push(type) - 1;
            this.type_numbers.set(type, number);
        }
        if (this.statements.has(id)) ++this.twice;
        this.statements.set(id, this.begins.length);
        this.type_of.push(number);
        this.begins.push(open);
        this.ends.push(close);
    }
}

/** Reads attributes from a bracket that Step has found to be closed. */
class Attributes {
    constructor(bytes, begin, end) {
        this.bytes = bytes;
        this.at = begin;
        this.end = end;
    }

    read() {
        return this.list();
    }

    list() {
        const out = [];
        ++this.at; // the bracket
        for (;;) {
            this.skip();
            if (this.at >= this.end || this.bytes[this.at] === kClose) break;
            out.push(this.value());
        }
        ++this.at;
        return out;
    }

    /** Where an attribute of the list begins and ends. */
    span(number) {
        ++this.at; // the bracket
        for (this.skip(); number > 0; --number, this.skip()) this.value();
        const from = this.at;
        if (from < this.end) this.value();
        return [from, Math.min(this.at, this.end)];
    }

    skip() {
        while (this.at < this.end && (this.bytes[this.at] <= kBlank || this.bytes[this.at] === 0x2c)) ++this.at;
    }

    value() {
        const bytes = this.bytes, from = this.at, c = bytes[from];
        if (c === kOpen) return this.list();
        if (c === kQuote) return this.text();
        if (c === kHash) {
            let id = 0;
            for (++this.at; isDigit(bytes[this.at]); ++this.at) id = id * 10 + (bytes[this.at] - 0x30);
            return new Ref(id);
        }
        if (c === kDot) {
            this.at = bytes.indexOf(kDot, from + 1) + 1;
            return new Enumeration(bytes.toString('latin1', from + 1, this.at - 1));
        }
        if (isDigit(c) || c === kMinus || c === 0x2b) {
            for (++this.at; isNumber(bytes[this.at]); ++this.at);
            return Number(bytes.toString('latin1', from, this.at));
        }
        if (isLetter(c)) {
            while (isWord(bytes[this.at])) ++this.at;
            const type = bytes.toString('latin1', from, this.at);
            this.skip();
            return new Typed(type, bytes[this.at] === kOpen ? this.list() : []);
        }
        if (c === kDouble) {
            this.at = bytes.indexOf(kDouble, from + 1) + 1;
            return bytes.toString('latin1', from + 1, this.at - 1);
        }
        ++this.at; // $ or *
        return null;
    }

    text() {
        const bytes = this.bytes, from = ++this.at;
        for (;; ++this.at) {
            if (bytes[this.at] !== kQuote) continue;
            const escaped = bytes[this.at - 1] === kBackslash && (bytes[this.at - 2] | 0x20) === 0x73 && bytes[this.at - 3] === kBackslash;
            if (escaped && this.at - 3 >= from) continue;
            if (bytes[this.at + 1] !== kQuote) break;
            ++this.at;
        }
        return decodeText(bytes.subarray(from, this.at++));
    }
}

/** A text of STEP: `''`, `\S\d`, `\X\hh`, `\X2\...\X0\`, `\X4\...\X0\`; bytes beyond ASCII as UTF-8 where they are that, else as Latin-1. */
export function decodeText(bytes) {
    let text = bytes.toString('utf8');
    if (text.includes('\ufffd')) text = bytes.toString('latin1');
    if (!text.includes('\\') && !text.includes("''")) return text;
    const hex = (digits, size) => {
        let out = '';
        for (let i = 0; i + size <= digits.length; i += size) {
            const code = parseInt(digits.slice(i, i + size), 16);
            if (code <= 0x10ffff) out += String.fromCodePoint(code);
        }
        return out;
    };
    return text.replace(/''|\\S\\([\s\S])|\\P[A-I]\\|\\X\\([0-9A-Fa-f]{2})|\\X2\\([0-9A-Fa-f]*)\\X0\\|\\X4\\([0-9A-Fa-f]*)\\X0\\|\\\\/g,
        (all, letter, one, two, four) => {
            if (all === "''") return "'";
            if (all === '\\\\') return '\\';
            if (letter !== undefined) return String.fromCharCode(letter.charCodeAt(0) | 0x80);
            if (one !== undefined) return hex(one, 2);
            if (two !== undefined) return hex(two, 4);
            if (four !== undefined) return hex(four, 8);
            return '';
        });
}
