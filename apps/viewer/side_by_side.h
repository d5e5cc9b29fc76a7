// One view culled in five ways, side by side: what each keeps, what it misses, and what it takes.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "apps/viewer/culler.h"

namespace sightline::viewer {

enum class Way : uint8_t {
    kCertificates,  ///< a query that remembers what hid what
    kProposals,     ///< the same, and it tries to prove what the GL's image of the last view did not show
    kTiles,         ///< a query that draws its buffer each time
    kQueries,       ///< the GL's occlusion queries, by CHC++
    kPyramid,       ///< two passes and a pyramid of depths, all on the GL
};
inline constexpr int kWays = 5;
inline constexpr const char* kWayNames[kWays] = {"certificates", "and proposals", "tiles", "occlusion queries",
                                                 "pyramid"};

/// What one way has found of the last view.
struct WayAnswer {
    std::vector<uint32_t> kept;  ///< objects, rising
    size_t missed = 0;           ///< objects that the image of all shows, and that are not kept
    double milliseconds = 0;     ///< on the GL with all drawing, until it is done
    std::string note;            ///< how it came about, in a few words
};

/// Each way keeps its own memory from view to view. The ways of the CPU promise to keep all that is visible, those of the
/// GL all that the image's own samples show: so they may keep less, and their answers come when all is drawn.
class SideBySide {
public:
    /// Uses the GL that is current, here and in all that follows.
    /// @param culler  its scene and world; must outlive it
    /// Errors: a GL older than 4.5, no memory.
    static Result<std::unique_ptr<SideBySide>> create(const Culler& culler);
    ~SideBySide();

    /// Asks all ways about a view. Sections do not cut what the GL draws: the view must have none.
    /// Errors: of the GL.
    Status ask(const View& view);

    const WayAnswer& of(Way way) const { return answers_[static_cast<int>(way)]; }
    /// Objects of which the GL's image of everything shows a sample.
    size_t seen() const { return seen_.size(); }

private:
    explicit SideBySide(const Culler& culler);
    Status prepare();
    void proposeUnseen();
    void askQuery(Way way, const View& view, const QuerySettings& settings);
    Status drawAll(const View& view);
    Status askQueries(const View& view);
    Status askPyramid(const View& view);
    WayAnswer& answerOf(Way way) { return answers_[static_cast<int>(way)]; }

    struct OnGl;
    const Culler& culler_;
    std::unique_ptr<OnGl> gl_;
    Query remembering_, proposed_to_, drawing_;
    WayAnswer answers_[kWays];
    std::vector<uint32_t> seen_, proposed_;  ///< rising
};

}  // namespace sightline::viewer
