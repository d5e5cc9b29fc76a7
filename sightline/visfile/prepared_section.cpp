// Writes prepared meshes, and reads them.
// SPDX-License-Identifier: MIT
#include "sightline/visfile/prepared_section.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "sightline/base/bytes.h"
#include "sightline/geom/occluder_bytes.h"

namespace sightline {

using namespace visibility_file;

namespace {

static_assert(std::equal(std::begin(occluder_bytes::kRecordBytes), std::end(occluder_bytes::kRecordBytes),
                         kPreparedRecordBytes + kPreparedOccluders));

/// The order of numbers that stand between a description of clusters and their arrays.
struct ClusterCounts {
    uint32_t triangles = 0, clusters = 0, facing = 0, closed = 0;
    uint32_t turned = 0, cones = 0;  ///< 1: there are such rows
    uint32_t mask_steps = 0, mask_words = 0;

    template <class Each>
    void each(Each visit) {
        for (uint32_t* count : {&triangles, &clusters, &facing, &closed, &turned, &cones, &mask_steps, &mask_words})
            visit(*count);
    }
};

size_t roundedUp(size_t count, size_t to) { return (count + to - 1) / to * to; }

class PreparedWriter {
public:
    explicit PreparedWriter(Memory* memory) : memory_(memory), runs_(memory) { runs_.resize(kPreparedRuns); }

    void put(const PreparedMesh& mesh) {
        const bool has_clusters = mesh.clusters.count() > 0;
        for (const size_t value : {mesh.inner.size(), size_t{mesh.occluder_is_shape} | size_t{mesh.has_shape} << 1,
                                   size_t{has_clusters}, mesh.lods.levels.size(), size_t{mesh.lods.parts}})
            to(kPreparedMeshes).put(static_cast<uint32_t>(value));
        putOccluder(mesh.occluder, occluders());
        putOccluder(mesh.shape, occluders());
        for (const InnerOccluder& inner : mesh.inner) {
            ByteWriter out = to(kPreparedInner);
            putBox(out, inner.outside);
            out.put(inner.error);
            putOccluder(inner.occluder, occluders());
        }
        if (has_clusters) putClusters(mesh.clusters);
        for (const LodLevel& level : mesh.lods.levels) {
            ByteWriter out = to(kPreparedLevels);
            out.put(level.error);
            out.put(level.triangles);
            out.put(level.vertices);
        }
        for (const uint32_t index : mesh.lods.indices) to(kPreparedIndices).put(index);
        for (const LodPart& range : mesh.lods.ranges) {
            to(kPreparedRanges).put(range.first);
            to(kPreparedRanges).put(range.count);
        }
    }
    void putObject(uint32_t mesh) { to(kPreparedObjects).put(mesh); }

    Array<char> section() const {
        Array<char> bytes(memory_);
        ByteWriter sizes(bytes);
        for (const Array<char>& run : runs_) sizes.put(uint64_t{run.size()});
        for (const Array<char>& run : runs_) bytes.insert(bytes.end(), run.begin(), run.end());
        return bytes;
    }

private:
    ByteWriter to(PreparedRun run) { return ByteWriter(runs_[run]); }
    std::span<Array<char>, occluder_bytes::kRuns> occluders() {
        return std::span<Array<char>, occluder_bytes::kRuns>(runs_.data() + kPreparedOccluders, occluder_bytes::kRuns);
    }

    void putClusters(const DrawClusters& clusters) {
        const FacingClusters& facing = clusters.facing;
        ByteWriter head = to(kPreparedClusters), numbers = to(kPreparedNumbers);
        ClusterCounts counts;
        counts.triangles = static_cast<uint32_t>(clusters.triangles.size());
        counts.clusters = static_cast<uint32_t>(clusters.count());
        counts.facing = static_cast<uint32_t>(facing.count());
        counts.closed = static_cast<uint32_t>(clusters.closed.size());
        counts.turned = !facing.turned.empty();
        counts.cones = !facing.cones.empty();
        counts.mask_steps = facing.masks.empty() ? 0 : facing.mask_steps;
        counts.mask_words = static_cast<uint32_t>(facing.mask_words.size());
        counts.each([&](uint32_t count) { head.put(count); });
        for (int axis = 0; axis < 3; ++axis) head.put(facing.origin[axis]);
        head.put(facing.reach);
        for (int axis = 0; axis < 3; ++axis) head.put(facing.mask_shape[axis]);
        for (const Array<uint32_t>* list : {&clusters.triangles, &clusters.first, &clusters.part})
            for (const uint32_t value : *list) numbers.put(value);
        for (const Array<float>* list : {&clusters.bounds, &facing.volumes, &facing.turned, &facing.cones})
            for (const float value : *list) numbers.put(value);
        for (const TriangleMasks& masks : facing.masks) {
            for (int axis = 0; axis < 3; ++axis) numbers.put(masks.center[axis]);
            numbers.put(masks.half);
            numbers.put(masks.first_word);
        }
        for (const uint64_t word : facing.mask_words) numbers.put(word);
        for (const ClosedClusters& solid : clusters.closed) {
            numbers.put(solid.first);
            numbers.put(solid.count);
            putBox(numbers, solid.box);
        }
    }

    Memory* const memory_;
    Array<Array<char>> runs_;
};

class PreparedReader {
public:
    PreparedReader(std::span<const char> bytes, uint64_t at, ByteFault& fault) : fault_(fault) { findRuns(bytes, at); }

    void read(size_t objects, PreparedMeshes& out) {
        Memory* const memory = out.meshes.memory();
        ByteCursor& heads = runs_[kPreparedMeshes];
        // Each has an occluder and a shape, which may be empty.
        if (fault_.none()) out.meshes.reserve(std::min(records(kPreparedMeshes), records(kPreparedOccluders) / 2));
        while (fault_.none() && heads.left() > 0) readMesh(out.meshes.emplace_back(memory));
        if (fault_.none()) occluders_.end();
        for (const PreparedRun run :
             {kPreparedInner, kPreparedClusters, kPreparedNumbers, kPreparedLevels, kPreparedIndices, kPreparedRanges})
            if (runs_[run].left() > 0) wrong("more than the meshes have", runs_[run].at());
        ByteCursor& mesh_of = runs_[kPreparedObjects];
        if (fault_.none() && records(kPreparedObjects) != objects) wrong("not a mesh for each object", mesh_of.at());
        if (fault_.none()) out.mesh_of_object.reserve(objects);
        while (fault_.none() && mesh_of.left() > 0) {
            const uint64_t at = mesh_of.at();
            out.mesh_of_object.push_back(mesh_of.take<uint32_t>());
            if (out.mesh_of_object.back() >= out.meshes.size() && out.mesh_of_object.back() != PreparedMeshes::kNone)
                wrong("an object of a mesh that there is not", at);
        }
    }

private:
    bool wrong(const char* what, uint64_t at) { return fault_.wrong(what, at); }
    bool findRuns(std::span<const char> bytes, uint64_t at) {
        constexpr uint64_t kSizesEnd = 8 * kPreparedRuns;
        ByteCursor sizes(bytes, at);
        if (bytes.size() < kSizesEnd) return wrong("prepared meshes that end within their head", at + bytes.size());
        uint64_t place = kSizesEnd;
        for (uint32_t run = 0; run < kPreparedRuns; ++run) {
            const uint64_t where = sizes.at(), size = sizes.take<uint64_t>();
            if (size > bytes.size() - place) return wrong("a run that is longer than its section", where);
            if (size % kPreparedRecordBytes[run] != 0) return wrong("a run that ends within a record", where);
            runs_[run] = ByteCursor(bytes.subspan(place, size), at + place);
            place += size;
        }
        return place == bytes.size() || wrong("bytes after the last run", at + place);
    }

    uint64_t records(PreparedRun run) const { return runs_[run].left() / kPreparedRecordBytes[run]; }

    void readMesh(PreparedMesh& mesh) {
        ByteCursor& head = runs_[kPreparedMeshes];
        const uint64_t at = head.at();
        const auto inner = head.take<uint32_t>(), marks = head.take<uint32_t>(), clusters = head.take<uint32_t>(),
                   levels = head.take<uint32_t>(), parts = head.take<uint32_t>();
        if (inner > records(kPreparedInner)) return (void)wrong("more inner occluders than the file has", at);
        if (marks > 2 || clusters > 1) return (void)wrong("marks that are not known", at);
        mesh.occluder_is_shape = marks == 1;
        mesh.has_shape = marks == 2;
        if (!occluders_.take(mesh.occluder) || !occluders_.take(mesh.shape)) return;
        if (!mesh.has_shape && !mesh.shape.clusters.empty()) return (void)wrong("a shape of a mesh without one", at);
        Memory* const memory = mesh.inner.memory();
        mesh.inner.reserve(inner);
        for (uint32_t i = 0; i < inner; ++i) {
            InnerOccluder& simple = mesh.inner.emplace_back(memory);
            ByteCursor& from = runs_[kPreparedInner];
            if (!takeBox(from, simple.outside, fault_) || !takeFinite(from, simple.error, fault_) ||
                !occluders_.take(simple.occluder))
                return;
        }
        if (clusters == 1 && !readClusters(mesh.clusters)) return;
        readLods(levels, parts, at, mesh.lods);
    }

    /// As many numbers as are asked for.
    template <class T>
    bool takeNumbers(Array<T>& list, uint64_t count) {
        ByteCursor& from = runs_[kPreparedNumbers];
        if (count > from.left() / sizeof(T)) return wrong("clusters that have more than the file", from.at());
        list.reserve(count);
        for (uint64_t i = 0; i < count; ++i) list.push_back(from.take<T>());
        return true;
    }

    bool readClusters(DrawClusters& clusters) {
        ByteCursor& head = runs_[kPreparedClusters];
        const uint64_t at = head.at();
        if (head.left() == 0) return wrong("fewer clusters than meshes that have some", at);
        ClusterCounts counts;
        counts.each([&](uint32_t& count) { count = head.take<uint32_t>(); });
        FacingClusters& facing = clusters.facing;
        for (int axis = 0; axis < 3; ++axis) facing.origin[axis] = head.take<double>();
        facing.reach = head.take<double>();
        for (int axis = 0; axis < 3; ++axis) facing.mask_shape[axis] = head.take<double>();
        for (int axis = 0; axis < 3; ++axis)
            if (!std::isfinite(facing.origin[axis]) || !(facing.mask_shape[axis] > 0 && facing.mask_shape[axis] <= 1))
                return wrong("clusters around nothing", at);
        if (!(facing.reach >= 0 && std::isfinite(facing.reach))) return wrong("clusters that reach nowhere", at);
        if (counts.clusters == 0 || counts.facing > counts.clusters || counts.turned > 1 || counts.cones > 1 ||
            counts.mask_steps > TriangleMasks::kMaxSteps || (counts.mask_steps == 0 && counts.mask_words > 0))
            return wrong("clusters whose numbers do not fit", at);
        clusters.stride = roundedUp(counts.clusters, DrawClusters::kPadding);
        facing.stride = roundedUp(counts.facing, FacingClusters::kPadding);
        const uint64_t numbers_at = runs_[kPreparedNumbers].at();
        if (!takeNumbers(clusters.triangles, counts.triangles) ||
            !takeNumbers(clusters.first, uint64_t{counts.clusters} + 1) ||
            !takeNumbers(clusters.part, counts.clusters) ||
            !takeNumbers(clusters.bounds, DrawClusters::kBoundsRows * clusters.stride) ||
            !takeNumbers(facing.volumes, FacingClusters::kVolumeRows * facing.stride) ||
            !takeNumbers(facing.turned, counts.turned * FacingClusters::kTurnedRows * facing.stride) ||
            !takeNumbers(facing.cones, counts.cones * FacingClusters::kConeRows * facing.stride))
            return false;
        if (clusters.first.front() != 0 || clusters.first.back() != counts.triangles)
            return wrong("clusters that are not their triangles", numbers_at);
        for (uint32_t i = 0; i < counts.clusters; ++i)
            if (clusters.first[i] >= clusters.first[i + 1]) return wrong("a cluster without triangles", numbers_at);
        for (const Array<float>* list : {&clusters.bounds, &facing.volumes, &facing.turned, &facing.cones})
            for (const float value : *list)
                if (!std::isfinite(value)) return wrong("a number that is not finite", numbers_at);
        facing.first.assign(clusters.first.begin(), clusters.first.begin() + counts.facing + 1);
        facing.triangles.assign(clusters.triangles.begin(), clusters.triangles.begin() + facing.first.back());
        return readMasks(counts, facing) && readClosed(counts, clusters);
    }

    bool readMasks(const ClusterCounts& counts, FacingClusters& facing) {
        ByteCursor& from = runs_[kPreparedNumbers];
        const uint64_t at = from.at();
        facing.mask_steps = counts.mask_steps;
        if (counts.mask_steps == 0) return true;
        if (counts.facing > from.left() / 20) return wrong("clusters that have more than the file", at);
        facing.masks.resize(counts.facing);
        for (TriangleMasks& masks : facing.masks) {
            for (int axis = 0; axis < 3; ++axis)
                if (!takeFinite(from, masks.center[axis], fault_)) return false;
            if (!takeFinite(from, masks.half, fault_)) return false;
            masks.first_word = from.take<uint32_t>();
        }
        if (!takeNumbers(facing.mask_words, counts.mask_words)) return false;
        for (uint32_t i = 0; i < counts.facing; ++i) {
            const TriangleMasks& masks = facing.masks[i];
            const uint64_t words = facing.sectors() * ((uint64_t{facing.size(i)} + 63) / 64);
            if (!(masks.half < 0) && masks.first_word + words > facing.mask_words.size())
                return wrong("masks that there are not", at + 20 * uint64_t{i});
        }
        return true;
    }

    bool readClosed(const ClusterCounts& counts, DrawClusters& clusters) {
        ByteCursor& from = runs_[kPreparedNumbers];
        if (counts.closed > from.left() / 32) return wrong("clusters that have more than the file", from.at());
        clusters.closed.resize(counts.closed);
        uint64_t end = 0;
        for (ClosedClusters& solid : clusters.closed) {
            const uint64_t at = from.at();
            solid.first = from.take<uint32_t>();
            solid.count = from.take<uint32_t>();
            if (!takeBox(from, solid.box, fault_)) return false;
            if (solid.first < end || uint64_t{solid.first} + solid.count > counts.facing)
                return wrong("a solid of clusters that there are not", at);
            end = uint64_t{solid.first} + solid.count;
        }
        return true;
    }

    void readLods(uint32_t levels, uint32_t parts, uint64_t at, LodChain& chain) {
        if (levels > kMostLods || levels > records(kPreparedLevels))
            return (void)wrong("more levels of detail than there are", at);
        if (levels == 0) return parts == 0 ? void() : (void)wrong("parts of no levels", at);
        chain.parts = parts;
        double error = 0;
        for (uint32_t i = 0; i < levels; ++i) {
            ByteCursor& from = runs_[kPreparedLevels];
            const uint64_t level_at = from.at();
            LodLevel& level = chain.levels.emplace_back();
            level.error = from.take<double>();
            level.triangles = from.take<uint32_t>();
            level.vertices = from.take<uint32_t>();
            if (!(level.error >= error && std::isfinite(level.error)))
                return (void)wrong("a level of detail that errs by less than a finer one", level_at);
            error = level.error;
        }
        const uint64_t ranges = uint64_t{levels - 1} * parts;
        if (ranges > records(kPreparedRanges)) return (void)wrong("more parts of levels than there are", at);
        uint64_t triangles = 0;
        for (uint64_t i = 0; i < ranges; ++i) {
            ByteCursor& from = runs_[kPreparedRanges];
            const uint64_t range_at = from.at();
            LodPart& range = chain.ranges.emplace_back();
            range.first = from.take<uint32_t>();
            range.count = from.take<uint32_t>();
            if (range.first != triangles) return (void)wrong("a part that does not follow on the one before", range_at);
            triangles += range.count;
            // As places in a 32-bit list of indices.
            if (3 * triangles > UINT32_MAX) return (void)wrong("more triangles than can be", range_at);
        }
        if (3 * triangles > records(kPreparedIndices))
            return (void)wrong("more triangles of levels than there are", at);
        chain.indices.reserve(3 * triangles);
        for (uint64_t i = 0; i < 3 * triangles; ++i) chain.indices.push_back(runs_[kPreparedIndices].take<uint32_t>());
    }

    ByteFault& fault_;
    ByteCursor runs_[kPreparedRuns];
    OccluderReader occluders_{&runs_[kPreparedOccluders], fault_};
};

}  // namespace

Array<char> preparedSection(std::span<const PreparedMesh> meshes, std::span<const uint32_t> mesh_of_object,
                            Memory* memory) {
    PreparedWriter writer(memory);
    for (const PreparedMesh& mesh : meshes) writer.put(mesh);
    for (const uint32_t mesh : mesh_of_object) writer.putObject(mesh);
    return writer.section();
}

Result<PreparedMeshes> readPreparedSection(std::span<const char> bytes, size_t objects, std::string_view file,
                                           uint64_t at, Memory* memory) {
    ByteFault fault;
    PreparedMeshes out(memory);
    PreparedReader(bytes, at, fault).read(objects, out);
    if (!fault.none()) return faultAt(file, fault.what, fault.at);
    return out;
}

}  // namespace sightline
