// What stands behind the handles of the C interface, and the hooks that each was made with.
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <new>
#include <utility>

#include "sightline/base/jobs.h"
#include "sightline/base/memory.h"
#include "sightline/c/base.h"

namespace sightline::c {

/// The allocator hook as a source of memory; without a hook the default one.
class HookMemory final : public Memory {
public:
    explicit HookMemory(const slAllocator& hook) : hook_(hook) {}
    void* allocate(size_t bytes, size_t alignment) override {
        return hook_.allocate ? hook_.allocate(hook_.user, bytes, alignment)
                              : defaultMemory()->allocate(bytes, alignment);
    }
    void deallocate(void* memory, size_t bytes, size_t alignment) override {
        if (hook_.release) return hook_.release(hook_.user, memory, bytes, alignment);
        defaultMemory()->deallocate(memory, bytes, alignment);
    }

private:
    const slAllocator hook_;
};

/// The job hook.
class HookJobs final : public Jobs {
public:
    explicit HookJobs(const slJobs& hook) : hook_(hook) {}
    void run(uint32_t count, Task task, void* context) override { hook_.run(hook_.user, count, task, context); }
    bool given() const { return hook_.run != nullptr; }

private:
    const slJobs hook_;
};

/// A copy of a caller's hooks. What was made with them shares it: a snapshot may outlive its world.
class Hooks {
public:
    explicit Hooks(const slHooks& from) : memory_(from.allocator), jobs_(from.jobs), log_(from.log) {}
    Memory* memory() { return &memory_; }
    Jobs* jobs() { return jobs_.given() ? &jobs_ : nullptr; }
    const slLog& log() const { return log_; }

private:
    HookMemory memory_;
    HookJobs jobs_;
    const slLog log_;
};
using SharedHooks = std::shared_ptr<Hooks>;

/// The hooks of the world that a query was asked about last, whose snapshot it keeps. Declared before the query, so that it goes
/// after it.
class AskedHooks {
public:
    /// Takes up the hooks of the next question. The ones before must live until it has been asked: they are returned.
    [[nodiscard]] SharedHooks exchange(const SharedHooks& next) { return std::exchange(last_, next); }

private:
    SharedHooks last_;
};

/// @param from  usable: see checkHooks(); null: no hooks
SharedHooks shareHooks(const slHooks* from);
SharedHooks shareHooks(const slLog& log);

/// Says a sentence to a log: the call, and what is wrong. Returns the status.
slStatus fail(const slLog& log, slStatus status, const char* call, const char* what);
/// The same with what the status itself says.
slStatus fail(const slLog& log, slStatus status, const char* call);

/// SL_OK, or why the hooks cannot be used.
slStatus checkHooks(const slHooks* hooks, const char* call);

/// A handle in the memory of its hooks. Handles begin with their hooks, so that these go last.
template <class Handle, class... Arguments>
Handle* makeHandle(const SharedHooks& hooks, Arguments&&... arguments) {
    void* const place = hooks->memory()->allocate(sizeof(Handle), alignof(Handle));
    return new (place) Handle{hooks, std::forward<Arguments>(arguments)...};
}
template <class Handle>
void destroyHandle(Handle* handle) {
    if (!handle) return;
    const SharedHooks hooks = handle->hooks;
    handle->~Handle();
    hooks->memory()->deallocate(handle, sizeof(Handle), alignof(Handle));
}

/// What slDefault...() writes into each kind of def.
enum Cookie : uint32_t {
    kViewCookie = 0x51e70001,
    kSettingsCookie,
    kWorldCookie,
    kOccluderCookie,
    kClustersCookie,
    kObjectCookie,
    kSightCookie,
    kLightCookie,
    kCasterCookie,
    kBakeCookie,
    kWayCookie,
};

}  // namespace sightline::c
