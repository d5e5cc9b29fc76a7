// Asks a recorded frame again, compares the answers, and takes the time.
// SPDX-License-Identifier: MIT
#include "sightline/query/record/frame_replay.h"

namespace sightline {

FrameReplay::FrameReplay(const FrameRecording& recording, Memory* memory)
    : recording_(recording),
      settings_(recording.settings),
      world_(World::create({.objects = static_cast<uint32_t>(recording.objects.size()),
                            .volumes = recording.volumes,
                            .memory = memory})),
      query_(memory),
      reasons_(recording.objects.size(), 0, memory) {
    settings_.stateless = true;
    settings_.hysteresis = 0;
    settings_.lod_fade = 0;
    settings_.time_stages = false;
    for (const FrameRecording::Form& form : recording.forms) world_.addOccluder(form.occluder, form.inner);
    for (const Array<LodLevel>& chain : recording.chains) world_.addLods(chain);
    for (const ObjectDef& object : recording.objects) world_.add(object);
    now_ = world_.commit();
}

FrameReplay::Answer FrameReplay::run() {
    Answer answer;
    answer.stats = query_.visible(now_, recording_.view, settings_).stats;
    query_.reasons(reasons_);
    for (uint32_t i = 0; i < recording_.again.size(); ++i) {
        if (reasons_[i] == recording_.again[i]) continue;
        if (answer.differences++ == 0) answer.different = i;
    }
    return answer;
}

}  // namespace sightline
