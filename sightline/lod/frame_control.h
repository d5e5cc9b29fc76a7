// How the time that frames took turns a knob: quality that follows the frame rate, and a cost model that follows the machine.
// SPDX-License-Identifier: MIT
//
// Thomas Funkhouser, Carlo Sequin. Adaptive Display Algorithm for Interactive Frame Rates During Visualization of
// Complex Virtual Environments. 1993 (reactive and predictive methods).
#pragma once

#include <algorithm>
#include <cmath>

namespace sightline {

/// A knob that is turned by how long the last frame took, between two limits: QuerySettings::lod_error (reactive level
/// of detail), QuerySettings::contribution (reactive detail culling), or the share of the resolution and the shading
/// that a renderer leaves out (reactive visual quality). It reacts after the fact: the frame in which the load jumps is
/// late. A budget (QuerySettings::budget) foresees it.
class ReactiveKnob {
public:
    struct Def {
        double target = 0;           ///< time of a frame  [any unit]
        double least = 0, most = 0;  ///< of the knob; more of it makes frames cheaper  [0 < least <= most]
        double calm = 0.1;           ///< within this share of the target the knob rests
        double response = 0.5;       ///< the knob goes with the excess to this power
        double largest_step = 1.5;   ///< by which factor one frame may turn it
    };

    explicit ReactiveKnob(const Def& def) : def_(def), value_(def.least) {}

    double value() const { return value_; }

    /// Takes the time of a frame that was drawn with value(). Times that are not positive numbers change nothing.
    /// @returns the knob for the next frame
    double observe(double time) {
        const double excess = time / def_.target;
        if (!(excess > 0.0) || !std::isfinite(excess)) return value_;
        if (std::abs(excess - 1.0) <= def_.calm) return value_;
        const double step = std::clamp(std::pow(excess, def_.response), 1.0 / def_.largest_step, def_.largest_step);
        return value_ = std::clamp(value_ * step, def_.least, def_.most);
    }

private:
    Def def_;
    double value_ = 0;
};

/// What a cost model must be multiplied by to fit the times that are measured: a filter that forgets.
class CostCorrection {
public:
    /// @param memory  share of the old factor that a new frame leaves  [0 to 1)
    explicit CostCorrection(double memory = 0.8) : memory_(memory) {}

    /// [ratio, > 0]
    double factor() const { return factor_; }

    /// Takes what a frame took, and what the model, without this factor, had said. Values that are not positive
    /// numbers change nothing; one frame counts as between half and twice of what was expected.
    void observe(double measured, double modelled) {
        const double ratio = measured / modelled;
        if (!(ratio > 0.0) || !std::isfinite(ratio)) return;
        const double seen = std::clamp(ratio, 0.5 * factor_, 2.0 * factor_);
        factor_ = memory_ * factor_ + (1.0 - memory_) * seen;
    }

private:
    double memory_ = 0.8;
    double factor_ = 1;
};

}  // namespace sightline
