// The tables of a glTF: buffers, buffer views and accessors, checked against the bytes that exist.
// SPDX-License-Identifier: MIT
//
// Khronos Group. glTF 2.0 Specification, sections 3.6 and 5. 2021.
// Arseny Kapoulkine, Jasper St. Pierre, Mike Lischke. EXT_meshopt_compression. 2021.
// Arseny Kapoulkine, Jasper St. Pierre, Alexey Knyazev, Don McCurdy. KHR_meshopt_compression. 2025.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sightline/tools/import/gltf/gltf_container.h"
#include "sightline/tools/import/gltf/gltf_json.h"
#include "sightline/tools/import/gltf/gltf_text.h"

namespace sightline::tools::gltf {

struct Compression {
    enum class Mode : uint8_t { kAttributes, kTriangles, kIndices };
    enum class Filter : uint8_t { kNone, kOctahedral, kQuaternion, kExponential, kColor };
    uint32_t buffer = 0;
    uint64_t offset = 0, length = 0;  ///< [bytes] compressed
    uint32_t stride = 0;              ///< [bytes] of an element
    uint64_t count = 0;
    Mode mode = Mode::kAttributes;
    Filter filter = Filter::kNone;

    uint64_t decodedSize() const { return count * stride; }
};

/// The extension's object of a buffer or a buffer view, of whichever name; the second has the layout of the first, a
/// filter for colours, and a second version of the vertex codec. Null if there is none.
const Json* findMeshopt(const Json& json, const std::string& place);

/// Reads and checks the extension's object: stride and count suit the mode and the filter, and the decoded
/// size is one that this many bytes can hold.
Compression readCompression(const Json& json, size_t buffers, const std::string& place);

/// @param source  [size: compression.length]
/// @return        [size: compression.decodedSize()]
std::vector<unsigned char> decompress(const Compression& compression, Bytes source, const std::string& place);

struct Buffer {
    enum class Source : uint8_t { kNone, kChunk, kUri };
    Source source = Source::kNone;  ///< kNone: a fallback that nothing may read
    uint64_t length = 0;            ///< [bytes]
    bool opened = false;
    std::vector<unsigned char> owned;  ///< of a data URI
    ByteSource file;
};

struct BufferView {
    uint32_t buffer = 0;
    uint64_t offset = 0, length = 0;  ///< [bytes] of the buffer, or of the data once decompressed
    uint32_t stride = 0;              ///< [bytes]; 0: packed
    std::optional<Compression> compression;
    std::optional<uint32_t> stream;  ///< in Document::streams: has no buffer, holds one of its attributes
    bool decoded = false;
    std::vector<unsigned char> data;  ///< decompressed
};

enum class Component : uint16_t {
    kByte = 5120,
    kUnsignedByte = 5121,
    kShort = 5122,
    kUnsignedShort = 5123,
    kUnsignedInt = 5125,
    kFloat = 5126,
};

/// [bytes] of one component.
uint32_t componentSize(Component component);

/// A run of elements in a buffer view; no view: zeros.
struct Elements {
    std::optional<uint32_t> view;
    uint64_t offset = 0;  ///< [bytes]
    Component component = Component::kFloat;
};

struct Sparse {
    uint64_t count = 0;
    Elements indices, values;
};

struct Accessor {
    static constexpr uint32_t kNone = ~0u;

    uint32_t number = kNone;  ///< in the file; kNone: it is not there
    Elements elements;
    uint64_t count = 0;
    uint32_t components = 1;  ///< SCALAR 1, VEC2 2, ..., MAT4 16
    bool normalized = false;
    std::optional<Sparse> sparse;
};

/// What is left of the memory that an import may take, in proportion to the bytes that it was given: a
/// small file cannot ask for a large world by naming one accessor many times.
class Budget {
public:
    void grant(uint64_t input_bytes);
    /// More for data that honestly packs a triangle into a sixth of a byte, as Draco does with smooth height fields.
    void grantPacked(uint64_t input_bytes);
    /// Throws a Fault if nothing is left.
    void charge(uint64_t count, uint64_t bytes_each, const std::string& place);
    /// For what was charged and is no longer held.
    void giveBack(uint64_t bytes) { left_ += bytes; }

private:
    uint64_t left_ = uint64_t(64) << 20;
    uint64_t packed_left_ = uint64_t(2) << 30;  // of what grantPacked may give in all
};

/// Tells how far an import is, in steps that a reader can see: no more than a thousand calls.
class Progress {
public:
    using Report = std::function<void(size_t done, size_t total)>;

    static constexpr size_t kRead = 100, kChecked = 200, kParsed = 400, kBuilt = 900, kTotal = 1000;  ///< thousandths

    explicit Progress(Report report = {}) : report_(std::move(report)) {}

    /// @param part  of the way from `from` to `to`  [0..1]
    void reach(size_t from, size_t to, double part);

private:
    Report report_;
    size_t told_ = 0;
};

/// The Draco data of one or more primitives; gltf_draco.h has what works with it.
struct DracoStream {
    struct Attribute {
        std::string name;
        uint32_t id = 0;        ///< in the stream
        uint32_t accessor = 0;  ///< in Document::accessors; added for the stream
    };
    std::string place;  ///< of the first primitive
    uint32_t view = 0;  ///< holds the stream
    std::vector<Attribute> attributes;
    std::optional<uint32_t> indices;  ///< accessor, added for the stream
    bool counts_triangles = false;    ///< the file says how many there are
    std::optional<uint64_t> triangles, vertices;
    bool granted = false;
    size_t uses = 0;    ///< that are still to come
    uint64_t held = 0;  ///< [bytes] unpacked
};

/// The JSON and its tables. What buffers hold is read and views decompressed when first asked for.
struct Document {
    JsonText json;
    ByteSource bytes;                      ///< of the file itself
    std::optional<ByteRange> chunk;        ///< the GLB's BIN chunk
    std::optional<std::string> directory;  ///< none: from memory, no files
    std::vector<Buffer> buffers;
    std::vector<BufferView> views;
    std::vector<Accessor> accessors;
    std::vector<DracoStream> streams;
    std::map<std::vector<uint64_t>, uint32_t> known_streams;
    bool draco_required = false;            ///< by extensionsRequired: there is no other data
    std::map<std::string, size_t> unknown;  ///< extensions that are not known, and how often each was met
    std::vector<std::string> notes;         ///< what the format forbids and is read all the same
    Budget budget;
    Progress progress;
};

/// Fills the tables from `json`. Afterwards each element of each accessor lies inside its view, and each
/// view inside its buffer.
void readTables(Document& document);

/// How to name an accessor in a Fault.
std::string accessorPlace(const Document& document, uint32_t accessor);

/// The bytes of a view, decompressed; of a stream's view those that unpackDraco() filled it with.
Bytes viewBytes(Document& document, uint32_t view);

}  // namespace sightline::tools::gltf
