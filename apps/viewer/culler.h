// A scene as a world, and what its camera sees of it: asked anew when something has changed.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sightline/query/query.h"
#include "sightline/query/shadow_query.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::viewer {

/// A door of the attached cells.
struct ViewerDoor {
    std::string name;   ///< of the door in the visibility file
    std::string label;  ///< the path of the object that shuts it, if there is one
    float open = 1;
    std::optional<uint32_t> object;  ///< that shuts it
    std::vector<std::vector<glm::dvec3>> portals;
    glm::dvec3 middle{0.0};
};

/// Whom an object of the answer hid.
struct HidesMost {
    uint32_t object = 0;
    double hidden = 0;  ///< objects; one that several hide is shared among them
};

/// Why an object is, or is not, in the answer.
struct ObjectWhy {
    std::string text;              ///< a paragraph
    std::vector<uint32_t> hiders;  ///< objects that hide it, those with the largest share first
    /// If it is hidden and they are found: parts of objects, as the eye sees them, whose shadows hold all of it.
    std::vector<std::vector<glm::dvec3>> outlines;
    bool kept = false;
};

class Culler {
public:
    /// @param scene  must outlive it
    /// @param world  of the scene, with its visibility file, if there is one
    Culler(const tools::Scene& scene, tools::LoadedWorld world, const QuerySettings& settings);

    QuerySettings settings;

    /// Asks, if the view, the settings or a door differ from those of the last answer.
    /// @returns whether it did
    bool ask(const View& view);

    /// Objects, rising: so that of two surfaces at one depth the same is shown, whatever is culled.
    std::span<const uint32_t> visible() const { return visible_; }
    /// The level of detail to draw of an object that is visible; 0 is the finest.
    uint8_t levelOf(uint32_t object) const { return object < levels_.size() ? levels_[object] : 0; }
    /// Of an object that is visible and has clusters, what the stage of clusters left: `object` is the scene's. Empty: all of it.
    std::span<const DrawRange> rangesOf(uint32_t object) const;
    /// The order of a mesh's triangles that ranges are of; empty: no clusters were prepared for it.
    std::span<const uint32_t> clusterOrder(uint32_t mesh) const { return cluster_orders_[mesh]; }
    bool hasClusters() const { return has_clusters_; }
    const QueryStats& stats() const { return stats_; }
    /// Whose answer it is.
    const Query& query() const { return query_; }
    /// Per object: 0 visible, 1 + Stage of the stage that culled it.  [size: objects]
    std::span<const uint8_t> reasons();
    /// Objects that may darken what is visible under a sun, those that are visible among them. Asked where it is first
    /// wanted after an answer.
    /// @param sun  where its light comes from
    std::span<const uint32_t> casters(const glm::dvec3& sun);
    const CasterStats& casterStats() const { return caster_stats_; }
    std::span<const SeenWindow> windows() { return query_.windows(); }
    Query::DepthImage depthImage() { return query_.depthImage(true); }

    ObjectWhy why(uint32_t object) const;
    /// The object's path; of several of one name, with its key.
    std::string nameOf(uint32_t object) const;
    /// Who hides most in the last answer, the most first. Costs some tens of queries, once an answer.
    std::span<const HidesMost> hidesMost();
    bool knowsHidesMost() const { return has_hides_; }

    std::vector<ViewerDoor>& doors() { return doors_; }
    bool hasCells() const;
    const Snapshot& now() const { return now_; }
    ObjectId idOf(uint32_t object) const { return world_.ids[object]; }
    uint32_t objectOf(ObjectId id) const { return object_of_[id.index]; }
    const tools::Scene& scene() const { return scene_; }
    /// In world space; may not be finite.
    const Box3d& boundsOf(uint32_t object) const { return bounds_[object]; }

private:
    void listDoors();
    void listClusters();
    void moveDoors();
    void takeRanges(const VisibleSet& set);

    const tools::Scene& scene_;
    tools::LoadedWorld world_;
    std::vector<uint32_t> object_of_;  ///< by the id's index
    std::vector<Box3d> bounds_;
    std::vector<ViewerDoor> doors_;
    std::vector<float> set_;  ///< how far each door was open in the last answer
    Snapshot now_;
    Query query_;
    View view_;
    QuerySettings asked_;
    bool fresh_ = false, has_reasons_ = false, has_casters_ = false, has_hides_ = false;
    std::vector<HidesMost> hides_;
    std::map<std::pair<std::string, uint32_t>, uint32_t> names_;  ///< objects of one name below one node
    std::vector<uint32_t> visible_, casters_;
    std::vector<uint8_t> levels_;                            ///< by object; empty: no levels were chosen
    std::vector<std::span<const uint32_t>> cluster_orders_;  ///< by mesh
    bool has_clusters_ = false;
    std::vector<DrawRange> ranges_;  ///< by object, rising
    std::vector<Visible> receivers_;
    ShadowQuery shadow_query_;
    CasterStats caster_stats_;
    std::vector<uint8_t> reasons_;
    QueryStats stats_;
};

}  // namespace sightline::viewer
