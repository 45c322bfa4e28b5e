#include "ecat/recording/frame_memory.hpp"

namespace taktwerk::ecat {

FrameMemory::FrameMemory(std::size_t bytes)
    : memories_{Recorder{bytes, Recorder::Policy::overwrite_oldest}, Recorder{bytes, Recorder::Policy::overwrite_oldest}} {}

void FrameMemory::tap(void* context, std::span<const std::byte> frame, Instant at, bool outgoing) noexcept {
    auto& memory = *static_cast<FrameMemory*>(context);
    const unsigned wanted = memory.wanted_.load(std::memory_order_acquire);  // what give_back() cleared is empty from here on
    memory.current_.store(wanted, std::memory_order_release);                // what was written before is the reader's
    memory.memories_[wanted].append(outgoing ? sent_frames : received_frames, at, frame);
}

void FrameMemory::ask() noexcept {
    if (out_) return;
    out_ = true;
    wanted_.store(1 - wanted_.load(std::memory_order_relaxed), std::memory_order_release);
}

const Recorder* FrameMemory::asked() const noexcept {
    const unsigned wanted = wanted_.load(std::memory_order_relaxed);
    return out_ && current_.load(std::memory_order_acquire) == wanted ? &memories_[1 - wanted] : nullptr;
}

void FrameMemory::give_back() noexcept {
    if (asked() == nullptr) return;
    memories_[1 - wanted_.load(std::memory_order_relaxed)].clear();
    out_ = false;
}

}  // namespace taktwerk::ecat
