// The proof of the occlusion scenes: every box that the buffer hides is looked for by two witnesses.
// SPDX-License-Identifier: MIT
#include "bench/occlusion_proof.h"

#include <algorithm>
#include <array>
#include <bit>
#include <thread>

#include <fmt/core.h>
#include <hwy/targets.h>

#include "sightline/buffer/depth_image.h"

namespace sightline::bench {
namespace {

constexpr uint32_t kImageSizes[][2] = {{1280, 720}, {1920, 1080}};

/// As FNV-1a, over words.
constexpr uint64_t kHashStart = 0xcbf29ce484222325ull;
void hashIn(uint64_t& hash, uint64_t word) {
    hash = (hash ^ word) * 0x100000001b3ull;
    hash ^= hash >> 32;  // so that high bits reach low ones
}

/// Puts an instruction set in force for as long as it lives.
class OnlyTarget {
public:
    explicit OnlyTarget(int64_t target) { hwy::SetSupportedTargetsForTest(target); }
    ~OnlyTarget() { hwy::SetSupportedTargetsForTest(0); }
    OnlyTarget(const OnlyTarget&) = delete;
    OnlyTarget& operator=(const OnlyTarget&) = delete;
};

/// What one camera's witnesses say.
void judge(const OcclusionScene& scene, const OcclusionFrame& frame, const BoxWitness& witness, const View& view,
           size_t camera, const HiddenBoxes& hidden, const ProofSettings& settings, OcclusionProof& proof) {
    std::vector<uint32_t> boxes;  // hidden by either detail
    std::vector<size_t> places;   // in view
    for (size_t i = 0; i < frame.boxes().size(); ++i) {
        if (!hidden.full[i] && !hidden.masked[i]) continue;
        boxes.push_back(frame.boxes()[i]);
        places.push_back(i);
    }
    std::vector<FalseBox> found(boxes.size());
    if (settings.pictures.jitters > 0) {
        const auto sightings = sightBoxes(scene, frame.batches(), boxes, view, settings.pictures);
        for (size_t k = 0; k < boxes.size(); ++k)
            if (sightings[k].seen)
                found[k] = {0,     0,         false,
                            false, "samples", glm::dvec2(sightings[k].pixel.x, view.height - sightings[k].pixel.y)};
        proof.samples += uint64_t{view.width} * view.height * settings.pictures.supersampling *
                         settings.pictures.supersampling * settings.pictures.jitters;
    }
    const BoxVerdict verdict = witness.judge(view, boxes, settings.rays);
    for (size_t k = 0; k < boxes.size(); ++k)
        if (verdict.boxes[k].seen) found[k] = {0, 0, false, false, "rays", verdict.boxes[k].pixel};
    proof.rays += verdict.rays;
    proof.edge_rays += verdict.edge_rays;
    proof.unconfirmed += verdict.unconfirmed;
    for (size_t k = 0; k < boxes.size(); ++k) {
        if (!*found[k].witness) continue;
        found[k].camera = camera;
        found[k].box = boxes[k];
        found[k].full = hidden.full[places[k]] != 0;
        found[k].masked = hidden.masked[places[k]] != 0;
        proof.false_full += found[k].full;
        proof.false_masked += found[k].masked;
        proof.false_boxes.push_back(found[k]);
    }
}

void addRows(const std::string& where, const OcclusionProof& proof, Table& table) {
    const auto add = [&](const std::string& what, uint64_t value, const char* unit, const char* baseline,
                         uint64_t other) -> Row& {
        return table.rows.emplace_back(
            Row{where, what, static_cast<double>(value), unit, baseline, static_cast<double>(other), ""});
    };
    add("false culls, a depth per pixel", proof.false_full, "boxes", "hidden and judged", proof.hidden_full);
    add("false culls, masked", proof.false_masked, "boxes", "hidden and judged", proof.hidden_masked);
    add("boxes in view", proof.boxes, "boxes", "cameras", proof.cameras);
    add("samples looked at", proof.samples, "samples", "boxes in view", proof.boxes);
    add("rays aimed at boxes", proof.rays, "rays", "of them past edges", proof.edge_rays);
    add("float's sightings not confirmed", proof.unconfirmed, "rays", "rays aimed at boxes", proof.rays);
    for (const OcclusionProof::Target& target : proof.targets)
        add("answers that differ on " + target.name, proof.differing(target), "cameras", "cameras", proof.cameras)
            .note = fmt::format("hash {:016x}", target.hash());
}

/// The proof's faults, a line each.
void addFaults(const std::string& where, const OcclusionProof& proof, Table& table) {
    for (const FalseBox& box : proof.false_boxes)
        table.faults.push_back(
            fmt::format("false cull: {}, camera {}: box {}, hidden {}, is seen at pixel ({:.6f}, {:.6f}) by {}", where,
                        box.camera, box.box,
                        box.full && box.masked ? "by both details"
                        : box.full             ? "by a depth per pixel"
                                               : "by masked tiles",
                        box.pixel.x, box.pixel.y, box.witness));
    for (const OcclusionProof::Target& target : proof.targets)
        if (const size_t count = proof.differing(target))
            table.faults.push_back(fmt::format("{}: {} answers otherwise than {} for {} of {} cameras", where,
                                               target.name, proof.targets.front().name, count, proof.cameras));
}

}  // namespace

HiddenBoxes hiddenBoxes(const OcclusionFrame& frame, DepthTiles& tiles) {
    HiddenBoxes out;
    const size_t count = frame.boxes().size();
    std::vector<uint8_t> flat(count), grouped(count);
    for (const bool masked : {false, true}) {
        const OcclusionDetail detail = masked ? OcclusionDetail::kMasked : OcclusionDetail::kFull;
        std::vector<uint8_t>& hidden = masked ? out.masked : out.full;
        frame.rasterize(tiles, OcclusionFrame::SelfTest::kYes, detail);
        frame.testGrouped(tiles, grouped);
        frame.testFlat(tiles, flat);
        for (size_t i = 0; i < count; ++i) hashIn(out.hash, flat[i] | uint64_t{grouped[i]} << 1);
        std::vector<float> nearness(size_t{tiles.width} * tiles.height);
        std::vector<uint8_t> covered(nearness.size());
        readDepthImage(tiles, Seams::kResolve, nearness, covered, 0.0f);
        for (size_t i = 0; i < nearness.size(); ++i)
            hashIn(out.hash, std::bit_cast<uint32_t>(nearness[i]) | uint64_t{covered[i]} << 32);
        hidden.resize(count);
        for (size_t i = 0; i < count; ++i) hidden[i] = flat[i] || grouped[i];
    }
    return out;
}

uint64_t OcclusionProof::Target::hash() const {
    uint64_t hash = kHashStart;
    for (uint64_t each : hashes) hashIn(hash, each);
    return hash;
}

size_t OcclusionProof::differing(const Target& target) const {
    size_t count = 0;
    for (size_t i = 0; i < target.hashes.size(); ++i) count += target.hashes[i] != targets.front().hashes[i];
    return count;
}

OcclusionProof proveOcclusion(const OcclusionScene& scene, OcclusionFrame& frame, const BoxWitness& witness,
                              uint32_t width, uint32_t height, const ProofSettings& settings) {
    OcclusionProof proof;
    proof.cameras = std::min(settings.most_cameras, scene.cameras.size());
    DepthTiles tiles;
    const int64_t all = hwy::SupportedTargets();
    proof.targets.push_back({hwy::TargetName(all & -all), {}});
    for (size_t camera = 0; camera < proof.cameras; ++camera) {
        const View view = occlusionView(scene, camera, width, height);
        frame.begin(view, settings.occlusion_size);
        const HiddenBoxes hidden = hiddenBoxes(frame, tiles);
        proof.targets.front().hashes.push_back(hidden.hash);
        proof.boxes += frame.boxes().size();
        for (size_t i = 0; i < frame.boxes().size(); ++i) {
            proof.hidden_full += hidden.full[i];
            proof.hidden_masked += hidden.masked[i];
        }
        judge(scene, frame, witness, view, camera, hidden, settings, proof);
    }
    for (int64_t left = settings.every_target ? all & (all - 1) : 0; left; left &= left - 1) {
        const OnlyTarget only(left & -left);
        OcclusionProof::Target target{hwy::TargetName(left & -left), {}};
        for (size_t camera = 0; camera < proof.cameras; ++camera) {
            frame.begin(occlusionView(scene, camera, width, height), settings.occlusion_size);
            target.hashes.push_back(hiddenBoxes(frame, tiles).hash);
        }
        proof.targets.push_back(target);
    }
    return proof;
}

void addProofs(const Options& options, Table& table) {
    const ProofOptions& asked = options.proof;
    const std::vector<std::string> names = options.only.empty() ? occlusionSceneNames() : options.only;
    std::vector<std::array<uint32_t, 2>> sizes;
    if (asked.width > 0) sizes.push_back({asked.width, asked.height});
    else
        for (const auto& size : kImageSizes) sizes.push_back({size[0], size[1]});
    ProofSettings settings;
    if (asked.cameras > 0) settings.most_cameras = asked.cameras;
    settings.pictures.jitters = asked.jitters;
    settings.rays.at_boxes = (asked.rays + 1) / 2;
    settings.rays.through_edges = asked.rays / 2;
    settings.pictures.threads = settings.rays.threads = std::max(1u, std::thread::hardware_concurrency());
    settings.pictures.band_samples >>= settings.pictures.threads > 8 ? 2 : 1;
    if (options.occlusion_size > 0) settings.occlusion_size = options.occlusion_size;
    size_t done = 0;
    for (const std::string& name : names) {
        const OcclusionScene scene = makeOcclusionScene(name);
        OcclusionFrame frame(scene);
        const BoxWitness witness(scene);
        for (const auto& [width, height] : sizes) {
            const OcclusionProof proof = proveOcclusion(scene, frame, witness, width, height, settings);
            const std::string where = fmt::format("{} {}x{}", name, width, height);
            addRows(where, proof, table);
            addFaults(where, proof, table);
            if (options.progress) options.progress(++done, names.size() * sizes.size());
        }
    }
}

}  // namespace sightline::bench
