// What of a convex occludee no shadow volume has hidden yet: the outline in the image, less the shadows, piece by piece.
// SPDX-License-Identifier: MIT
//
// Satyan Coorg, Seth Teller. Real-Time Occlusion Culling for Models with Large Occluders. 1997.
// Ivan Sutherland, Gary Hodgman. Reentrant Polygon Clipping. 1974.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "sightline/cull/occluder_volumes.h"
#include "sightline/cull/proofs/image_frame.h"

namespace sightline {

/// A volume and its planes in the image of its view.
struct Shadow {
    struct Line {
        glm::dvec3 line;   ///< (u, v, 1) may be within where the dot with it is positive by the slack
        double still = 0;  ///< slack that grows towards the eye, at distance one
    };
    static constexpr uint32_t kMostFaces = 4;

    OccluderVolume volume;
    uint32_t line_count = 0, face_count = 0;
    Line lines[OccluderVolume::kMaxPlanes];  ///< planes through the eye
    glm::dvec4 faces[kMostFaces];            ///< the others
    double slack[kMostFaces][2];

    /// Whether a body lies wholly in the volume.
    /// @param corners  relative to the eye, each off by `error` at most
    bool holds(const glm::dvec3* corners, uint32_t count, double error) const;
};
/// @returns false if it has too many faces
bool makeShadow(const ImageFrame& frame, Shadow& shadow);

/// Decides whether several volumes together hide a convex body, where no single one holds all of it.
///
/// The argument. A volume is bounded by planes through the eye, which are lines in the image, and by the planes of its
/// faces. So it hides each point of the body that appears within its lines, but for those that are not behind its faces.
/// What is not behind a face is the body cut by a plane: convex again, and so is its image. What a volume leaves of the
/// outline is hence what lies outside of a line, and what lies within the image of such a cut; once nothing is left, each
/// point of the body lies in a volume, and OccluderVolume says why it is hidden.
///
/// Rounding. Each line is moved inward by kMargin beyond the slack of its plane, taken at the body's nearest point, where it
/// is largest, and by how far a corner may lie elsewhere; each cut is made too large by as much, and more. A computed piece
/// differs from what it stands for by that, and by some 1e-15 for each line that it was cut by, of which there are a few
/// hundred at most. By induction, what is left in truth lies within so much of what is left here: a point near a piece that
/// is dropped is within the lines by more than the slack. Nothing is dropped for being small. A cut is passed over for a
/// piece only if it lies beyond one of its sides by twice what cuts are too large.
class Uncovered {
public:
    static constexpr uint32_t kMostCorners = 32;

    /// Takes up the part of a body that is in the image, and not before the near plane.
    /// @param view     VolumeView::usable, and of the same view as the frame
    /// @param corners  relative to the eye [limit: count <= kMostCorners]
    /// @param error    no corner lies elsewhere by more  [world units]
    /// @param box      they are those of a box, turned or sheared, in the order of Box::corner()
    /// @returns false if the body cannot be told apart from the eye, and stays visible
    bool begin(const VolumeView& view, const ImageFrame& frame, const glm::dvec3* corners, uint32_t count, double error,
               bool box);
    /// The share of what is left that a volume of the same view hides, at least; 0 also where it cannot be told.
    double share(const Shadow& shadow);
    /// Takes away what a volume of the same view hides, if that is more than a share of what is left.
    /// @returns the share that it took; 0: nothing
    double remove(const Shadow& shadow, double least = 0);
    /// Takes away whatever a volume of the same view hides.
    void take(const Shadow& shadow);
    /// Takes up a body of which nothing can be seen.
    void clear() { piece_count_ = 0; }
    /// Outlines that were made, and pieces that volumes were taken from, so far over all bodies.
    uint64_t cuts() const { return cuts_; }
    bool nothing() const { return piece_count_ == 0; }
    /// Into the middle of the largest piece: dot(frame.w, direction) = 1.
    glm::dvec3 direction() const;
    /// Beside the largest piece: on both sides of it, if it is a slit.
    /// @param around  all around it, if it is small, as where slits meet, or one crosses another behind it
    /// @returns how many directions; 0: it is not so
    uint32_t besideSlit(bool around, glm::dvec3 (&directions)[8]) const;
    /// The greatest dot(frame.w, q) of the body.
    double farthest() const { return farthest_; }

private:
    static constexpr uint32_t kMostPieces = 24;
    static constexpr uint32_t kMostOfPiece = 24;
    static constexpr uint32_t kMostPoints = 8 * kMostCorners;

    struct Piece {
        uint32_t count = 0;
        glm::dvec2 corner[kMostOfPiece];

        Piece() {}  // corners are not cleared
        Piece(const Piece& other) { *this = other; }
        Piece& operator=(const Piece& other) {
            count = other.count;
            for (uint32_t i = 0; i < count; ++i) corner[i] = other.corner[i];
            return *this;
        }
        double area() const;
    };
    /// Points whose hull is convex, in the image.
    struct Cloud {
        uint32_t count = 0;
        glm::dvec2 point[kMostPoints];
        bool outline(Piece& piece);
    };

    Piece* pieces() { return both_[now_]; }  ///< what is left
    const Piece* pieces() const { return both_[now_]; }
    Piece* next() { return both_[1 - now_]; }  ///< what a shadow would leave
    const Piece& largest() const;
    static bool split(const Piece& from, const glm::dvec3& line, Piece& within, Piece& outside);
    bool addPoint(Cloud& cloud, const glm::dvec3& q) const;
    bool cutOff(const glm::dvec4& plane, Cloud& cloud) const;
    bool isBeside(const Cloud& cloud, const Piece& piece) const;
    enum class Meets : uint8_t { kNot, kPartly, kWhole };
    static Meets meets(const Piece& piece, const glm::dvec3* lines, uint32_t count, uint32_t& crossing);
    const Piece* cutAlong(const Piece& piece, const glm::dvec3* lines, uint32_t crossing, Piece* both);
    bool subtract(const Shadow& shadow);
    void takeNext();
    bool keepBefore(const Piece& piece, const Piece& before);
    bool push(const Piece& piece);
    bool clipNear(const VolumeView& view, const glm::dvec3* corners, uint32_t count, bool box);

    ImageFrame frame_;
    glm::dvec3 body_[kMostPoints];
    uint32_t body_count_ = 0;
    bool is_box_ = false;
    double error_ = 0, nearest_ = 0, farthest_ = 0, reach_ = 0;
    double margin_ = 0;  ///< by which cuts are too large
    Piece both_[2][kMostPieces];
    uint32_t now_ = 0;  ///< of these
    uint64_t cuts_ = 0;
    uint32_t piece_count_ = 0, next_count_ = 0;
};

}  // namespace sightline
