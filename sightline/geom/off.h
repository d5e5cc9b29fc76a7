// What one setting or declaration of a view has switched off of another, bit by bit, with a sentence for each.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace sightline {

/// Bits of QueryStats::off. kOffRows has a row for each.
enum class Off : uint32_t {
    kMemoryByStateless = 1u << 0,
    kCertificatesByView = 1u << 1,
    kCertificatesByStages = 1u << 2,
    kBinsByStages = 1u << 3,
    kBinsByCertificates = 1u << 4,
    kClusterLookByCertificates = 1u << 5,
    kGapsByCertificates = 1u << 6,
    kClustersByTwoEyes = 1u << 7,
    kHardBudgetByTwoEyes = 1u << 8,
    kCellsBySections = 1u << 9,
    kStagesByEyeRadius = 1u << 10,
    kWindowByStages = 1u << 11,
    kOccludersByLods = 1u << 12,
    kCertificatesByWorld = 1u << 13,
};
inline constexpr uint32_t offBit(Off off) { return static_cast<uint32_t>(off); }

/// One row of the table.
struct OffRow {
    Off off;
    const char* name;   ///< as JSON has it
    const char* words;  ///< what is off, and why
};

/// All of them, in the order of their bits: the tool, JSON, C, Python and the pages read this table.
inline constexpr OffRow kOffRows[] = {
    {Off::kMemoryByStateless, "memory_by_stateless",
     "certificates, unasked answers: `stateless` remembers nothing of the answers before"},
    {Off::kCertificatesByView, "certificates_by_view",
     "certificates, unasked answers: they need a perspective view; this one is parallel, or too wide"},
    {Off::kCertificatesByStages, "certificates_by_stages",
     "certificates: they need the stage frustum beside the stage occlusion"},
    {Off::kBinsByStages, "bins_by_stages", "bins: strips need the stages frustum and occlusion"},
    {Off::kBinsByCertificates, "bins_by_certificates",
     "bins: the answer rests on certificates or proposals, which one thread checks"},
    {Off::kClusterLookByCertificates, "cluster_look_by_certificates",
     "occlusion of clusters: the answer rests on certificates: nothing is drawn that clusters could be held against"},
    {Off::kGapsByCertificates, "gaps_by_certificates",
     "close_gaps: the answer rests on certificates: nothing is drawn that has gaps"},
    {Off::kClustersByTwoEyes, "clusters_by_two_eyes", "stage clusters: it chooses the triangles of one eye alone"},
    {Off::kHardBudgetByTwoEyes, "hard_budget_by_two_eyes",
     "hard_budget: of two eyes nothing is left out: the coarsest levels are drawn"},
    {Off::kCellsBySections, "cells_by_sections",
     "stages pvs and portals: sections open walls that cells take for shut"},
    {Off::kStagesByEyeRadius, "stages_by_eye_radius",
     "all stages but pvs and distance: eye_radius asks for every eye and every direction around"},
    {Off::kWindowByStages, "window_by_stages", "View::window: it needs the stage frustum"},
    {Off::kOccludersByLods, "occluders_by_lods",
     "hiding by objects that a coarser level may stand for: a coarser level may show what the finest hides"},
    {Off::kCertificatesByWorld, "certificates_by_world",
     "certificates, stage volumes: the world was made without WorldDef::volumes, the parts that they hide by"},
};

}  // namespace sightline
