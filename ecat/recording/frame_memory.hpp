#pragma once
// The last moments of a bus, in memory, for whoever wants to know afterwards what was on the wire. Two memories: the cycle writes over the oldest
// of the one while a reader, who asked for it, looks through the other in peace. The tap side is real-time safe and allocates nothing.
//
//     FrameMemory memory{16 << 20};     master.set_tap(&FrameMemory::tap, &memory);
//     memory.ask();     ...     if (const auto* moments = memory.asked()) { moments->for_each(...); memory.give_back(); }

#include <array>
#include <atomic>
#include <cstddef>
#include <span>

#include "core/recorder.hpp"
#include "core/time.hpp"
#include "ecat/recording/frame_capture.hpp"

namespace taktwerk::ecat {

class FrameMemory {
public:
    /// Takes `bytes` twice, at once. A frame needs its own bytes and 16 to 31 more. Not real-time.
    explicit FrameMemory(std::size_t bytes);

    /// For Master::set_tap(); `context` is the FrameMemory. The cycle's thread alone.
    static void tap(void* context, std::span<const std::byte> frame, Instant at, bool outgoing) noexcept;

    // --- one reader, any thread ----------------------------------------------------------------------------------------------
    /// From its next frame on the cycle writes into the other memory. Nothing while one is out.
    void ask() noexcept;
    /// What was asked for (channels sent_frames and received_frames), or nullptr: the cycle has had no frame since, or nothing was asked for.
    [[nodiscard]] const Recorder* asked() const noexcept;
    /// Read: it is empty, and may be asked for again.
    void give_back() noexcept;
    /// What the cycle writes into: for after its last frame.
    [[nodiscard]] const Recorder& at_end() const noexcept { return memories_[current_.load(std::memory_order_acquire)]; }

private:
    std::array<Recorder, 2> memories_;
    std::atomic<unsigned> current_{0};  ///< the cycle's
    std::atomic<unsigned> wanted_{0};   ///< the reader's
    bool out_ = false;                  ///< the reader's: asked for, and not given back
};

}  // namespace taktwerk::ecat
