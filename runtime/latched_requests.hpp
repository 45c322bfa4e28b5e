#pragma once
// Axis requests of a slower task: collected while it runs, carried out at its next release, when its outputs apply too. The
// task gets an id at once; until the axis has given the real one, the task's own latched view shows the command as queued.
// Real-time safe; used by one thread at a time (the task's, then the cycle's).

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "axes/axis/motion_context.hpp"

namespace taktwerk::runtime {

class LatchedRequests final : public axes::AxisRequests {
public:
    static constexpr std::size_t capacity = 64;
    /// Ids that the task sees have this bit set: they never meet an axis' own.
    static constexpr axes::CommandId provisional = 0x8000'0000u;

    explicit LatchedRequests(std::size_t axes) : power_(axes) {}

    // --- the task's side --------------------------------------------------------------------------------------------------
    /// The views that the task reads: submitted commands show up in them.
    void bind(std::span<axes::AxisView> views) noexcept { views_ = views; }
    axes::Submitted submit(axes::AxisRef axis, const axes::AxisCommand& command, axes::Owner owner) noexcept override;
    axes::ErrorId power(axes::AxisRef axis, bool enable, bool positive, bool negative, axes::Owner owner) noexcept override;
    axes::ErrorId reset(axes::AxisRef axis, axes::Owner owner) noexcept override;
    axes::ErrorId set_position(axes::AxisRef axis, double position, bool relative, axes::Owner owner) noexcept override;
    void release_stop(axes::AxisRef axis, axes::CommandId id, axes::Owner owner) noexcept override;
    axes::ErrorId renew_jog(axes::AxisRef axis, axes::CommandId id, double velocity, axes::Owner owner) noexcept override;

    // --- the cycle's side ---------------------------------------------------------------------------------------------------
    /// Carries out what the task has asked for, in its order.
    void apply(axes::AxisRequests& axes) noexcept;
    /// Levels that must be renewed in every base cycle: the power wishes.
    void renew(axes::AxisRequests& axes) const noexcept;
    /// Copies the axes' views for the next run, with the task's own ids in place of the real ones.
    void latch(std::span<const axes::AxisView> real, std::span<axes::AxisView> task_views) noexcept;
    void clear() noexcept;

private:
    enum class Kind : std::uint8_t { submit, reset, set_position, release_stop, renew_jog };
    struct Request {
        Kind kind = Kind::submit;
        axes::AxisRef axis;
        axes::AxisCommand command;
        axes::CommandId id = 0;
        axes::Owner owner = axes::Owner::program;
        double value = 0;
        bool relative = false;
    };
    struct Known {  // what became of a provisional id
        axes::CommandId mine = 0, real = 0;
        std::uint16_t axis = 0xFFFF;
        axes::ErrorId refused = axes::ErrorId::none;
        bool told = false;   // a refusal is shown in one latch: the block reads it in its next call
    };
    struct PowerWish {
        bool held = false, enable = false, positive = true, negative = true;
        axes::Owner owner = axes::Owner::program;
        axes::ErrorId answer = axes::ErrorId::none;
    };
    bool push(const Request& request) noexcept;
    [[nodiscard]] axes::CommandId real_id(axes::CommandId mine) const noexcept;

    std::array<Request, capacity> requests_{};
    std::size_t count_ = 0;
    std::array<Known, capacity> known_{};
    std::size_t known_next_ = 0;
    axes::CommandId next_ = 0;
    mutable std::vector<PowerWish> power_;
    std::span<axes::AxisView> views_;
};

}  // namespace taktwerk::runtime
