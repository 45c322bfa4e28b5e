#pragma once
// What frames have to bring before a simulated slave takes something: keys that unlock writing for the rest of a frame (0020h, 0030h), and the
// letters at 0040h that reset it, one in each of three frames in a row. Source: ETG.1000.4.

#include <array>
#include <cstddef>
#include <cstdint>

namespace taktwerk::ecat::sim {

class FrameKeys {
public:
    void power_on() noexcept {
        registers_unlocked_ = all_unlocked_ = false;
        reset_step_ = 0;
    }
    /// What the last frame unlocked is locked again.
    void begin_frame() noexcept {
        registers_unlocked_ = all_unlocked_ = false;
        ++frames_;
    }
    void unlock_registers() noexcept { registers_unlocked_ = true; }
    void unlock_all() noexcept { all_unlocked_ = true; }
    [[nodiscard]] bool registers_unlocked() const noexcept { return registers_unlocked_; }
    [[nodiscard]] bool all_unlocked() const noexcept { return all_unlocked_; }

    /// 0040h was written; true: this was the last letter of 'R', 'E', 'S'.
    bool reset_key(std::byte value) noexcept {
        constexpr std::array keys{std::byte{'R'}, std::byte{'E'}, std::byte{'S'}};
        const bool next = value == keys[reset_step_] && (reset_step_ == 0 || frames_ == reset_frame_ + 1);
        reset_step_ = next ? reset_step_ + 1 : value == keys[0] ? 1u : 0u;
        reset_frame_ = frames_;
        if (reset_step_ < keys.size()) return false;
        reset_step_ = 0;
        return true;
    }

private:
    bool registers_unlocked_ = false, all_unlocked_ = false;
    std::uint64_t frames_ = 0, reset_frame_ = 0;
    unsigned reset_step_ = 0;
};

}  // namespace taktwerk::ecat::sim
