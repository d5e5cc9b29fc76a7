// The z-buffer among the hidden-surface methods: tiled, many samples at once, on several threads.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/zbuffer/zbuffer_method.h"

#include <algorithm>
#include <atomic>
#include <barrier>
#include <cmath>
#include <thread>
#include <unordered_map>
#include <utility>
#include <vector>

#include "sightline/geom/view.h"
#include "sightline/math/box.h"
#include "sightline/studies/hidden/draw_item.h"
#include "sightline/studies/hidden/methods/presort.h"
#include "sightline/studies/hidden/threads.h"
#include "sightline/studies/hidden/zbuffer/depth_buffer_draw.h"
#include "sightline/studies/hidden/zbuffer/depth_format.h"

namespace sightline::studies {
namespace {

// Bounds of what is to be drawn: items that lie outside of the view as a whole, and the depths that a list spans.

/// One thread's own. Boxes of meshes that several items share are computed once.
class ItemBounds {
public:
    explicit ItemBounds(const View& view);

    /// True only if no sample can show anything of an item: its box lies beyond one plane of the view volume, with four
    /// samples to spare at the sides. False in doubt.
    bool isOutside(const DrawItem& item);

    /// The item's box in eye space, eye and view direction as in View; empty for an item without vertices.
    Box3d inEyeSpace(const DrawItem& item);

private:
    const Box3d& boxOf(const MeshView& mesh);
    glm::dmat4 toEye(const DrawItem& item) const;

    glm::dvec3 eye_;
    glm::dmat3 rotation_;
    glm::dmat4 projection_;
    double room_x_, room_y_;
    std::unordered_map<const glm::vec3*, Box3d> boxes_;
};

ItemBounds::ItemBounds(const View& view)
    : eye_(eyePosition(view)),
      rotation_(glm::dmat3(view.view)),
      projection_(view.projection),
      room_x_(1 + 8.0 / view.width),
      room_y_(1 + 8.0 / view.height) {}

const Box3d& ItemBounds::boxOf(const MeshView& mesh) {
    const auto [place, is_new] = boxes_.try_emplace(mesh.positions.data());
    if (is_new) {
        glm::vec3 low(std::numeric_limits<float>::infinity()), high(-low);
        for (const glm::vec3& p : mesh.positions) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        place->second = {glm::dvec3(low), glm::dvec3(high)};
    }
    return place->second;
}

glm::dmat4 ItemBounds::toEye(const DrawItem& item) const {
    glm::dmat4 to_eye(rotation_ * glm::dmat3(item.transform));
    to_eye[3] = glm::dvec4(rotation_ * (glm::dvec3(item.transform[3]) - eye_), 1.0);
    return to_eye;
}

Box3d ItemBounds::inEyeSpace(const DrawItem& item) { return transformBox(boxOf(item.mesh), toEye(item)); }

bool ItemBounds::isOutside(const DrawItem& item) {
    const Box3d& box = boxOf(item.mesh);
    if (!box.finite()) return box.empty();
    const glm::dmat4 to_clip = projection_ * toEye(item);
    constexpr double kRoom = 1 + 1e-9;  // for the near and the far plane: more than rounding
    int left = 0, right = 0, bottom = 0, top = 0, before = 0, beyond = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 p =
            to_clip * glm::dvec4(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                                 corner & 4 ? box.max.z : box.min.z, 1.0);
        left += p.x < -room_x_ * p.w && p.x < -p.w;
        right += p.x > room_x_ * p.w && p.x > p.w;
        bottom += p.y < -room_y_ * p.w && p.y < -p.w;
        top += p.y > room_y_ * p.w && p.y > p.w;
        before += p.z < -p.w && p.z + p.w < -1e-9 * (std::abs(p.z) + std::abs(p.w));
        beyond += p.z > kRoom * std::abs(p.w);
    }
    return left == 8 || right == 8 || bottom == 8 || top == 8 || before == 8 || beyond == 8;
}

/// A view's range, and what of it a list's items span if that is wanted: a little more on both sides.
DepthRange fitDepthRange(const DrawList& list, const View& view) {
    DepthRange range = depthRange(view);
    ItemBounds bounds(view);
    double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
    for (const DrawItem& item : list.items()) {
        const Box3d box = bounds.inEyeSpace(item);
        if (!box.finite() || bounds.isOutside(item)) continue;
        nearest = std::min(nearest, -box.max.z);
        farthest = std::max(farthest, -box.min.z);
    }
    if (!(nearest <= farthest)) return range;
    if (!range.orthographic) {  // distances are w, whatever that is of an eye-space z
        farthest *= std::abs(view.projection[2][3]);
        if (farthest > range.near_plane) range.far_plane = std::min(range.far_plane, farthest * (1 + 1e-3));
        return range;
    }
    const double room = 1e-3 * (farthest - nearest) + 1e-6 * (std::abs(farthest) + std::abs(nearest)) + 1e-30;
    const double near_plane = std::max(range.near_plane, nearest - room);
    const double far_plane = std::min(range.far_plane, farthest + room);
    if (near_plane < far_plane) {
        range.near_plane = near_plane;
        range.far_plane = far_plane;
    }
    return range;
}

/// Triangles of one item that one thread projects.
struct Piece {
    uint32_t item = 0;
    uint32_t first = 0, end = 0;
};

/// As many as one thread projects at a time.
constexpr uint32_t kPieceTriangles = 1 << 11;

/// Pieces that are projected before their polygons are drawn. A batch of polygons is a run of pieces, so that small
/// items share one.
class Rounds {
public:
    /// @param order  of the items; empty for that of the list
    Rounds(const DrawList& list, size_t triangles, std::vector<uint32_t> order)
        : list_(list), limit_(triangles), order_(std::move(order)) {}

    /// The next pieces, parted into batches; false at the end.
    bool next(std::vector<std::vector<Piece>>& batches) {
        batches.clear();
        size_t sum = 0, in_batch = kPieceTriangles;
        for (; next_ < list_.items().size(); ++next_, triangle_ = 0) {
            const uint32_t item = order_.empty() ? next_ : order_[next_];
            const uint32_t count = static_cast<uint32_t>(list_.items()[item].mesh.triangles());
            while (triangle_ < count) {
                if (sum >= limit_) return true;
                if (in_batch >= kPieceTriangles) {
                    batches.emplace_back();
                    in_batch = 0;
                }
                const uint32_t end = std::min(count, triangle_ + kPieceTriangles - static_cast<uint32_t>(in_batch));
                batches.back().push_back({item, triangle_, end});
                in_batch += end - triangle_;
                sum += end - triangle_;
                triangle_ = end;
            }
        }
        return !batches.empty();
    }

private:
    const DrawList& list_;
    const size_t limit_;
    const std::vector<uint32_t> order_;
    uint32_t next_ = 0, triangle_ = 0;
};

void addUp(ProjectorCounters& sum, const ProjectorCounters& more) {
    sum.triangles += more.triangles;
    sum.rejected += more.rejected;
    sum.back_facing += more.back_facing;
    sum.accepted += more.accepted;
    sum.clipped += more.clipped;
    sum.produced += more.produced;
    sum.spared += more.spared;
}

void addUp(HiddenCounters& sum, const HiddenCounters& more) {
    sum.generated += more.generated;
    sum.tested += more.tested;
    sum.passed += more.passed;
    sum.shaded += more.shaded;
    sum.hierarchy_rejected_polygons += more.hierarchy_rejected_polygons;
    sum.hierarchy_rejected_tiles += more.hierarchy_rejected_tiles;
    sum.hierarchy_accepted_tiles += more.hierarchy_accepted_tiles;
    sum.depth_bytes += more.depth_bytes;
    sum.depth_bytes_compressed += more.depth_bytes_compressed;
}

/// One thread's share in the work.
class Worker {
public:
    explicit Worker(const HiddenInput& input) : input_(input), projector_(input.projector()), bounds_(input.view) {}

    void project(const std::vector<Piece>& pieces, const PolygonTarget& target, PolygonBatch& out) {
        out.clear((target.height + 7) / 8);
        for (const Piece& piece : pieces) project(piece, target, out);
    }

    DepthDrawScratch scratch;

    void finish(HiddenCounters& sum) {
        addUp(scratch.counters.geometry, projector_.counters());
        addUp(sum.geometry, scratch.counters.geometry);
        addUp(sum, scratch.counters);
    }

private:
    void project(const Piece& piece, const PolygonTarget& target, PolygonBatch& out) {
        const DrawItem& item = input_.list.items()[piece.item];
        if (begun_ != piece.item) {
            begun_ = piece.item;
            outside_ = bounds_.isOutside(item);
            if (!outside_) projector_.begin(item);
        }
        const auto isDrawn = [&](size_t triangle) {
            return item.writes_depth.empty() || item.writes_depth[triangle] != 0;
        };
        if (outside_) {
            for (uint32_t triangle = piece.first; triangle < piece.end; ++triangle) {
                if (!isDrawn(triangle)) continue;
                ++scratch.counters.geometry.triangles;
                ++scratch.counters.geometry.rejected;
            }
            return;
        }
        const bool clipless = input_.settings.projector.clipping == Clipping::kClipless;
        const uint32_t first_surface = input_.list.firstSurface(piece.item);
        for (uint32_t triangle = piece.first; triangle < piece.end; ++triangle) {
            if (!isDrawn(triangle)) continue;
            if (clipless) {
                if (!projector_.projectHomogeneous(triangle, triangle_)) continue;
                triangle_.surface = first_surface + triangle;
                out.add(triangle_, target);
            } else {
                if (!projector_.project(triangle, polygon_)) continue;
                polygon_.surface = first_surface + triangle;
                out.add(polygon_, target);
            }
        }
    }

    const HiddenInput& input_;
    Projector projector_;
    ItemBounds bounds_;
    uint32_t begun_ = ~0u;  ///< the item that the projector has taken up
    bool outside_ = false;
    ScreenPolygon polygon_;
    HomogeneousTriangle triangle_;
};

/// Threads take turns: all project, then all draw; what is next to do is settled while they wait for one another.
class Drawing {
public:
    Drawing(const HiddenInput& input, HiddenImage& image, ZBufferMemory& memory)
        : input_(input),
          depth_(input.settings.depth),
          codec_(depthCodecFor(input.list, input.view, depth_.format)),
          memory_(memory),
          buffer_(memory.buffer),
          draw_{buffer_, codec_, depth_, depth_.comparison.value_or(codec_.convention.comparison), image},
          target_{image.width, image.height, codec_, depth_.offset_factor, depth_.offset_units},
          rounds_(input.list,
                  input.settings.threads > 1 && !depth_.compression ? kSharedBatchTriangles : kBatchTriangles,
                  depth_.near_to_far ? orderItems(input.list, input.view, DepthOrder::kNearToFar)
                                     : std::vector<uint32_t>()) {
        buffer_.resize(image.width, image.height);
        buffer_.clear(depth_.clear_value ? codec_.keyOf(*depth_.clear_value) : codec_.convention.far_value,
                      depth_.fast_clear);
    }

    void run(HiddenImage& image) {
        const size_t count = std::clamp<size_t>(input_.settings.threads, 1, buffer_.rows);
        std::vector<Worker> workers;
        workers.reserve(count);
        for (size_t i = 0; i < count; ++i) workers.emplace_back(input_);
        advance();
        std::barrier projected(static_cast<ptrdiff_t>(count), []() noexcept {});
        FirstFault fault;
        std::barrier drawn(static_cast<ptrdiff_t>(count), [&]() noexcept {
            fault.guard([this] { advance(); });
            done_ |= fault.any();
        });
        const auto work = [&](uint32_t i) {
            while (!done_) {
                fault.guard([&] { projectAll(workers[i]); });
                projected.arrive_and_wait();
                if (!fault.any()) fault.guard([&] { drawAll(workers[i]); });
                drawn.arrive_and_wait();
            }
        };
        std::vector<std::thread> threads = startThreads(static_cast<uint32_t>(count), work);
        for (size_t missing = threads.size() + 1; missing < count; ++missing) {
            projected.arrive_and_drop();
            drawn.arrive_and_drop();
        }
        work(0);
        for (std::thread& thread : threads) thread.join();
        fault.rethrow();
        for (Worker& worker : workers) worker.finish(image.counters);
    }

private:
    void advance() {
        done_ = !rounds_.next(pieces_);
        if (memory_.batches.size() < pieces_.size()) memory_.batches.resize(pieces_.size());
        next_batch_ = 0;
        next_row_ = 0;
    }

    void projectAll(Worker& worker) {
        for (size_t i; (i = next_batch_++) < pieces_.size();) worker.project(pieces_[i], target_, memory_.batches[i]);
    }

    void drawAll(Worker& worker) {
        for (uint32_t row; (row = next_row_++) < buffer_.rows;)
            drawTileRow(draw_, row, {memory_.batches.data(), pieces_.size()}, worker.scratch);
    }

    const HiddenInput& input_;
    const DepthSettings& depth_;
    DepthCodec codec_;
    ZBufferMemory& memory_;
    DepthBuffer& buffer_;
    DepthDraw draw_;
    PolygonTarget target_;
    Rounds rounds_;
    std::vector<std::vector<Piece>> pieces_;  ///< of this round, by batch
    std::atomic<size_t> next_batch_ = 0;
    std::atomic<uint32_t> next_row_ = 0;
    bool done_ = false;
};

}  // namespace

DepthCodec depthCodecFor(const DrawList& list, const View& view, DepthFormat format) {
    const DepthRange range = depthRange(view);
    const bool fit = range.orthographic ||
                     (format == DepthFormat::kLinear && range.far_plane == std::numeric_limits<double>::infinity());
    return {format, fit ? fitDepthRange(list, view) : range};
}

void drawZBuffer(const HiddenInput& input, HiddenImage& image) {
    ZBufferMemory own;
    ZBufferMemory* kept = input.settings.zbuffer_memory;
    Drawing(input, image, kept != nullptr ? *kept : own).run(image);
}

}  // namespace sightline::studies
