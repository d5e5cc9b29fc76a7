// An explanation in plain sentences.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/run/explain_text.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "sightline/tools/report/readable.h"

namespace sightline::tools {
namespace {

/// A length with three or four digits that matter.
std::string units(double length) { return readable(length, std::abs(length) < 100 ? 3 : 4); }

std::string percent(double share) {
    if (share > 0 && share < 0.005) return "under 1 %";
    return fmt::format("{:.0f} %", 100 * share);
}

/// "'Wall' (71 %), 'Door' (20 %) and 3 others (9 %)"; without shares where they are not known.
/// @param most  names; of more than one, another rather than "1 other"
std::string listOf(const Array<Hider>& hiders, const NameOfObject& name, size_t most = 6) {
    const size_t shown = hiders.size() > most + (most > 1) ? most : hiders.size();
    std::vector<std::string> parts;
    const auto ofAll = [&](double share) {
        return hiders.size() > 1 && hiders[0].share > 0 ? fmt::format(" ({})", percent(share)) : std::string();
    };
    double rest = 1;
    for (size_t i = 0; i < shown; ++i) {
        parts.push_back(name(hiders[i].id) + ofAll(hiders[i].share));
        rest -= hiders[i].share;
    }
    if (shown < hiders.size()) parts.push_back(counted(hiders.size() - shown, "other") + ofAll(std::max(rest, 0.0)));
    std::string text;
    for (size_t i = 0; i < parts.size(); ++i) text += (i == 0 ? "" : i + 1 < parts.size() ? ", " : " and ") + parts[i];
    return text;
}

const char* pronoun(size_t count) { return count == 1 ? "that one" : count == 2 ? "these two" : "these"; }

std::string clustersText(const ClustersReason& found) {
    return fmt::format("of {}, {} seen from the back, {} outside of the view, {} hidden",
                       counted(found.clusters, "cluster"), readable(static_cast<double>(found.back)),
                       readable(static_cast<double>(found.outside)), readable(static_cast<double>(found.hidden)));
}

std::string lodText(const LodReason& found) {
    if (found.levels < 2) return "";
    std::string text = fmt::format(" It is drawn by level {} of {}", found.drawn.level, found.levels);
    if (found.drawn.level > 0) text += fmt::format(", which errs by {} pixels", readable(found.error, 2));
    if (std::isfinite(found.next_error))
        text += fmt::format("; the next would err by {}", readable(found.next_error, 2));
    return text + ".";
}

std::string drawnText(const ClustersReason& found) {
    if (found.clusters == 0) return "";
    return fmt::format(" Of its {} triangles {} are left to draw: {}.", readable(static_cast<double>(found.triangles)),
                       readable(static_cast<double>(found.drawn)), clustersText(found));
}

std::string togetherText(const Explanation& why) {
    if (why.together <= 1) return "";
    return fmt::format(" It was culled in one step with {} object{} that {} near it.", readable(why.together - 1.0),
                       why.together == 2 ? "" : "s", why.together == 2 ? "lies" : "lie");
}

std::string rectangleText(const Explanation& why) {
    if (!why.on_screen) return "";
    const double left = std::max(why.rect.left, 0.0), right = std::min<double>(why.rect.right, why.width);
    const double top = std::max(why.rect.top, 0.0), bottom = std::min<double>(why.rect.bottom, why.height);
    return fmt::format(" Its box takes {:.0f} x {:.0f} pixels from ({:.0f}, {:.0f}) and begins {} units away.",
                       std::max(right - left, 0.0), std::max(bottom - top, 0.0), left, top, units(why.depth));
}

/// "beyond the left plane by 3.2 units".
std::string planeText(const FrustumReason& reason) {
    if (reason.by_triangles) return "out of view: its box reaches into it, but none of its triangles does";
    if (reason.by_faces) return "out of view: the box along the axes reaches into it, but not its own, which is turned";
    const char* const name = kPlaneNames[reason.plane];
    const std::string where = reason.plane < FrustumReason::kFirstSection ? fmt::format("the {} plane", name) : name;
    return fmt::format("beyond {} by {} units", where, units(reason.distance()));
}

/// Whether drawing would keep it.
bool isByCertificateAlone(const Explanation& why) {
    const Array<Hider>& hiders = why.occlusion.hiders;
    return why.verdict == Verdict::kOccluded && !why.certificate.empty() && !hiders.empty() && hiders[0].share == 0;
}

std::string certificateText(const Explanation& why, const NameOfObject& name) {
    if (why.certificate.empty() || isByCertificateAlone(why)) return "";
    Array<Hider> named;
    for (const Visible& hider : why.certificate) named.push_back({hider.id, hider.key, 0});
    return " A certificate culled it, which names " + listOf(named, name) + ".";
}

std::string frustumText(const Explanation& why, const std::string& subject, const NameOfObject& name) {
    const FrustumReason& reason = why.frustum;
    std::string text = fmt::format("culled by frustum: {} lies {}", subject, planeText(reason));
    std::string also;
    for (uint32_t plane = 0; plane < FrustumReason::kPlanes; ++plane)
        if (plane != reason.plane && reason.outside[plane] > 0)
            also +=
                fmt::format("{}{} by {}", also.empty() ? "" : ", ", kPlaneNames[plane], units(reason.outside[plane]));
    if (!also.empty()) text += " (and beyond " + also + ")";
    text +=
        reason.by_rectangle ? "; its rectangle on the screen showed it, the planes could not tell for rounding." : ".";
    return text + togetherText(why) + certificateText(why, name);
}

/// Of an object of which all that lies in the view is turned away.
std::string awayText() { return "faces in the view that all look away from the eye"; }

std::string facingText(const Explanation& why, const std::string& subject) {
    return fmt::format(
               "culled by facing: {} has {}, and they are single-sided: a face is drawn from its front alone. (Sides "
               "that "
               "are wrongly turned in the file are drawn by --sides both.)",
               subject, awayText()) +
           togetherText(why) + rectangleText(why);
}

std::string withoutText(const OcclusionReason& reason, const NameOfObject& name) {
    const std::string who = fmt::format("without {}", pronoun(reason.hiders.size()));
    switch (reason.without) {
        case Without::kNotAsked:
            return "";
        case Without::kVisible:
            return "; " + who + " it would be kept";
        case Without::kOutsideFrustum:
            return "; " + who + " the frustum would cull it";
        case Without::kFacesAway:
            return "; " + who + " it would be culled, for its faces look away";
        case Without::kTooFar:
            return "; " + who + " it would be left out as too far away";
        case Without::kTooSmall:
            return "; " + who + " it would be left out as too small";
        case Without::kOccluded:
            break;
    }
    return "; " + who + " it would still be hidden, by " + listOf(reason.others, name);
}

/// What was asked where the rectangle around its box was open.
std::string askedText(const OcclusionReason& reason) {
    if (reason.by_triangles) return " The rectangle around its box is not hidden all over; its own triangles are.";
    if (reason.by_faces) return " The rectangle around its box is not hidden all over; the faces of the box are.";
    return "";
}

std::string occlusionText(const Explanation& why, const std::string& subject, const NameOfObject& name) {
    const OcclusionReason& reason = why.occlusion;
    if (isByCertificateAlone(why))
        return fmt::format(
                   "culled by occlusion: {} lies in the shadow of {}: a certificate proves it. Drawing would keep it.",
                   subject, listOf(reason.hiders, name)) +
               rectangleText(why);
    if (reason.hiders.empty()) return fmt::format("culled by occlusion: {}.", subject) + rectangleText(why);
    const std::string hiders = listOf(reason.hiders, name);
    std::string text;
    if (reason.stage == Stage::kVolumes)
        text = fmt::format("culled by volumes: all of {} lies in the shadow of {}", subject, hiders);
    else if (reason.outside_too)
        text = fmt::format(
            "culled by occlusion: {} was culled in one step with {} objects near it, all behind {}. By "
            "itself it lies {}, out of view",
            subject, readable(why.together - 1.0), hiders, planeText(why.frustum));
    else if (reason.sufficient) text = fmt::format("culled by occlusion: {} lies behind {}", subject, hiders);
    else
        text =
            fmt::format("culled by occlusion: {} lies behind {}, and is hidden only with the rest of the world there",
                        subject, hiders);
    text += withoutText(reason, name) + ".";
    if (reason.outside_too && reason.stage == Stage::kOcclusion) return text + certificateText(why, name);
    return text + askedText(reason) + togetherText(why) + rectangleText(why) + certificateText(why, name);
}

std::string farText(const SizeReason& reason) {
    return fmt::format("{} away, more than {}", units(reason.distance), units(reason.distance_limit));
}

std::string smallText(const SizeReason& reason) {
    return fmt::format("as large as a disk of radius {} pixels, less than {}", readable(reason.radius, 3),
                       readable(reason.radius_limit, 3));
}

std::string keptText(const Explanation& why, const NameOfObject& name) {
    const VisibleReason& reason = why.visible;
    switch (reason.because) {
        case KeptBecause::kOpenPixel:
            break;
        case KeptBecause::kViewNotUsable:
            return "in doubt: the view's matrices cannot be used, so that everything is kept";
        case KeptBecause::kBoundsNotUsable:
            return "in doubt: its bounds are empty, not finite or too far away";
        case KeptBecause::kHoldsEye:
            return "in doubt: the eye is inside its box";
        case KeptBecause::kNearPlane:
            return "in doubt: its box reaches across the near plane";
        case KeptBecause::kNotProjectable:
            return "in doubt: its box cannot be projected without too much rounding";
        case KeptBecause::kStageOff:
            if (reason.stage == Stage::kFrustum)
                return fmt::format("the frustum stage is off; it lies {}", planeText(why.frustum));
            return "the occlusion stage is off, and it is in the frustum";
        case KeptBecause::kBudgetSpent:
            return reason.second_look_spent
                       ? "in doubt: the budget of polygons for a second look (--second-look-polygons) was spent before "
                         "its triangles were asked, which are hidden"
                       : "in doubt: the budget of occluder triangles (--occluder-triangles) was spent before what "
                         "would "
                         "hide it was drawn";
    }
    std::string where = fmt::format("nothing hides pixel ({:.1f}, {:.1f})", reason.x, reason.y);
    if (reason.covered && reason.cover != ObjectId() && reason.cover == why.id) where += ", which it covers itself";
    else if (reason.covered)
        where += fmt::format(": {} covers it, but not in front of the nearest point of {}",
                             reason.cover == ObjectId() ? "something" : name(reason.cover),
                             reason.by_triangles ? "its triangles there"
                             : reason.by_faces   ? "its box's faces there"
                                                 : "its box");
    const double part = reason.pixels ? double(reason.open_pixels) / double(reason.pixels) : 0.0;
    return where + fmt::format("; {} of {} is open", percent(part),
                               reason.by_triangles ? "what its own triangles touch"
                               : reason.by_faces   ? "what its box's faces touch"
                                                   : "its rectangle");
}

/// "it stands in 2 cells, of which 1 is seen through 3 portals, beside it".
std::string cellsText(const CellsReason& cells) {
    const std::string stands = "it stands in " + counted(cells.object.size(), "cell");
    if (cells.reached == 0) return stands + ", into which no window leads";
    return fmt::format("{}, of which {} {} seen, through {}, but it lies beside all windows", stands, cells.reached,
                       cells.reached == 1 ? "is" : "are", counted(cells.portals.size(), "portal"));
}

std::string rowsText(const CellsReason& cells) {
    if (cells.view_cells > 0)
        return "it is seen from nowhere in " + counted(cells.view_cells, "view cell") + " that the eye may be in";
    return fmt::format("it stands in {}, none of which is seen from {} that the eye may be in",
                       counted(cells.object.size(), "cell"), counted(cells.eye.size(), "cell"));
}

}  // namespace

std::string explanationText(const Explanation& why, const std::string& subject, const NameOfObject& name,
                            const std::string& seen) {
    switch (why.verdict) {
        case Verdict::kNoSuchObject:
            return "there is no such object.";
        case Verdict::kOutsideLayers:
            return fmt::format("left out: {} is in none of the view's layers.", subject);
        case Verdict::kOutsideFrustum:
            return frustumText(why, subject, name);
        case Verdict::kOccluded:
            return occlusionText(why, subject, name);
        case Verdict::kTooFar:
            return fmt::format("culled by distance: {} is {}. It may be visible.", subject, farText(why.size)) +
                   togetherText(why) + rectangleText(why);
        case Verdict::kTooSmall:
            return fmt::format("culled by contribution: {} looks {}. It may be visible.", subject,
                               smallText(why.size)) +
                   togetherText(why) + rectangleText(why);
        case Verdict::kNoCluster:
            return fmt::format("culled by clusters: of {} none is left: {}.", subject, clustersText(why.clusters)) +
                   rectangleText(why);
        case Verdict::kNoTime:
            return fmt::format("culled by lod: the budget has no time for {}. It may be visible.", subject) +
                   rectangleText(why);
        case Verdict::kNotInPvs:
            return fmt::format("culled by pvs: {}: {}.", subject, rowsText(why.cells));
        case Verdict::kNoWindow:
            return fmt::format("culled by portals: {}: {}.", subject, cellsText(why.cells));
        case Verdict::kFacesAway:
            return facingText(why, subject);
        case Verdict::kVisible:
            break;
    }
    std::string reason = keptText(why, name);
    if (!seen.empty()) reason[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(reason[0])));
    return fmt::format("kept: {}{} {}.", subject, seen.empty() ? ":" : " " + seen, reason) + rectangleText(why) +
           lodText(why.lod) + drawnText(why.clusters) +
           (why.unasked ? " It was kept without a question, because it was visible a few answers before." : "");
}

std::string explanationClause(const Explanation& why, const NameOfObject& name, size_t most) {
    switch (why.verdict) {
        case Verdict::kNoSuchObject:
            return "no such object";
        case Verdict::kOutsideLayers:
            return "in none of the view's layers";
        case Verdict::kOutsideFrustum:
            return planeText(why.frustum);
        case Verdict::kOccluded:
            return "behind " + listOf(why.occlusion.hiders, name, most) +
                   (!why.certificate.empty()     ? ", by a certificate"
                    : why.occlusion.by_triangles ? ", by its triangles"
                                                 : "");
        case Verdict::kTooFar:
            return farText(why.size);
        case Verdict::kTooSmall:
            return smallText(why.size);
        case Verdict::kNoCluster:
            return clustersText(why.clusters);
        case Verdict::kNoTime:
            return "no time in the budget";
        case Verdict::kNotInPvs:
            return rowsText(why.cells);
        case Verdict::kNoWindow:
            return cellsText(why.cells);
        case Verdict::kFacesAway:
            return awayText();
        case Verdict::kVisible:
            break;
    }
    return keptText(why, name);
}

std::string stageOf(const Explanation& why) {
    if (why.verdict == Verdict::kOutsideFrustum) return kStageNames[static_cast<int>(Stage::kFrustum)];
    if (why.verdict == Verdict::kOccluded) return kStageNames[static_cast<int>(why.occlusion.stage)];
    if (why.verdict == Verdict::kTooFar) return kStageNames[static_cast<int>(Stage::kDistance)];
    if (why.verdict == Verdict::kTooSmall) return kStageNames[static_cast<int>(Stage::kContribution)];
    if (why.verdict == Verdict::kNoCluster) return kStageNames[static_cast<int>(Stage::kClusters)];
    if (why.verdict == Verdict::kNoTime) return kStageNames[static_cast<int>(Stage::kLod)];
    if (why.verdict == Verdict::kNotInPvs) return kStageNames[static_cast<int>(Stage::kPvs)];
    if (why.verdict == Verdict::kNoWindow) return kStageNames[static_cast<int>(Stage::kPortals)];
    if (why.verdict == Verdict::kFacesAway) return kStageNames[static_cast<int>(Stage::kFacing)];
    return "";
}

const char* verdictName(Verdict verdict) {
    constexpr const char* kNames[] = {"no such object", "outside layers", "visible",   "outside frustum",
                                      "occluded",       "too far",        "too small", "no cluster",
                                      "no time",        "not in PVS",     "no window", "faces away"};
    return kNames[static_cast<int>(verdict)];
}

const char* keptBecauseName(KeptBecause because) {
    constexpr const char* kNames[] = {"open pixel", "view not usable", "bounds not usable", "holds the eye",
                                      "near plane", "not projectable", "stage off",         "budget spent"};
    return kNames[static_cast<int>(because)];
}

std::string wrapped(const std::string& text, size_t width, const std::string& indent) {
    std::string out, line;
    const std::string_view all = text;
    for (size_t at = 0; at < all.size();) {
        const size_t end = std::min(all.find(' ', at), all.size());
        const std::string_view word = all.substr(at, end - at);
        if (!line.empty() && line.size() + 1 + word.size() > width) {
            out += line + "\n";
            line = indent;
            line += word;
        } else {
            if (!line.empty()) line += ' ';
            line += word;
        }
        at = end + 1;
    }
    return out + line;
}

}  // namespace sightline::tools
