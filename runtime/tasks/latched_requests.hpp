#pragma once
// Axis requests of a slower task: collected while it runs, carried out at its next release, when its outputs apply too. The
// task gets an id at once; until the axis has given the real one, the task's own latched view shows the command as queued.
//
// Answers that a base task gets at once come a release later, in the task's latched view:
//   submit        the ledger shows the refusal under the task's id, in one latch (at most half a ledger of them each time; the rest waits)
//   power         the answer of the last release is returned by the next call
//   reset         the view shows `resetting`, in the next latch no more, with reset_error saying why
//   set           gets an id like a command: the ledger shows done or the refusal. SetPosition is checked in the call, too
//   update        a refusal is lost; the command goes on with its last good values
//   renew_jog     the lease runs out
// Real-time safe. Task's side and cycle's side take turns (SlowTask hands over), except renew(), which may run beside the task.

#include <array>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "axes/axis/motion_context.hpp"

namespace taktwerk::runtime {

class LatchedRequests final : public axes::AxisRequests {
public:
    static constexpr std::size_t capacity = 64;
    /// Ids that the task sees have this bit set: they never meet an axis' own.
    static constexpr axes::CommandId provisional = 0x8000'0000u;

    explicit LatchedRequests(std::size_t axes)
        : known_(known_per_axis * axes + capacity), wishes_(axes), held_(axes), resets_(axes), told_(axes) {}

    // --- the task's side --------------------------------------------------------------------------------------------------
    /// The views that the task reads: submitted commands show up in them.
    void bind(std::span<axes::AxisView> views) noexcept { views_ = views; }
    axes::Submitted submit(axes::AxisRef axis, const axes::AxisCommand& command, axes::Owner owner) noexcept override;
    axes::ErrorId power(axes::AxisRef axis, bool enable, bool positive, bool negative, axes::Owner owner) noexcept override;
    axes::ErrorId reset(axes::AxisRef axis, axes::Owner owner) noexcept override;
    axes::Submitted set(axes::AxisRef axis, const axes::AxisSetting& setting, axes::Owner owner) noexcept override;
    axes::ErrorId update(axes::AxisRef axis, axes::CommandId id, const axes::AxisCommand& command, axes::Owner owner) noexcept override;
    void release_stop(axes::AxisRef axis, axes::CommandId id, axes::Owner owner) noexcept override;
    axes::ErrorId renew_jog(axes::AxisRef axis, axes::CommandId id, double velocity, axes::Owner owner) noexcept override;

    // --- the cycle's side ---------------------------------------------------------------------------------------------------
    /// Carries out what the task has asked for, in its order.
    void apply(axes::AxisRequests& axes) noexcept;
    /// Levels that must be renewed in every base cycle: the power wishes that have been applied.
    void renew(axes::AxisRequests& axes) noexcept;
    /// Copies the axes' views for the next run, with the task's own ids in place of the real ones.
    void latch(std::span<const axes::AxisView> real, std::span<axes::AxisView> task_views) noexcept;
    void clear() noexcept;

private:
    enum class Kind : std::uint8_t { submit, update, reset, set, release_stop, renew_jog };
    struct Request {
        Kind kind = Kind::submit;
        axes::AxisRef axis;
        axes::AxisCommand command;
        axes::CommandId id = 0;
        axes::Owner owner = axes::Owner::program;
        double value = 0;
        axes::AxisSetting setting;
    };
    struct Known {  // what became of a provisional id; forgotten once nothing of it shows any more
        enum class Fate : std::uint8_t { accepted, done, refused };
        axes::CommandId mine = 0, real = 0;  // real: while accepted
        std::uint16_t axis = 0xFFFF;
        Fate fate = Fate::accepted;
        bool told = false;
        axes::ErrorId error = axes::ErrorId::none;
    };
    struct PowerWish {
        bool given = false, enable = false, positive = true, negative = true;
        axes::Owner owner = axes::Owner::program;
        axes::ErrorId answer = axes::ErrorId::none;
    };
    struct RefusedReset {
        enum class Show : std::uint8_t { nothing, resetting, error } show = Show::nothing;
        axes::ErrorId error = axes::ErrorId::none;
    };
    /// What an axis shows of commands: active, queued, finished.
    static constexpr std::size_t known_per_axis = 32;
    static constexpr std::uint8_t most_told = std::tuple_size_v<decltype(axes::AxisView::ledger)> / 2;

    bool push(const Request& request) noexcept;
    /// Takes a request with an id of its own: in the task's view it is queued from now on.
    [[nodiscard]] axes::Submitted push_with_id(Request& request) noexcept;
    void remember(const Request& request, axes::Submitted answer) noexcept;
    /// Puts the task's id in place of the axis' one; false when the axis has forgotten the command.
    [[nodiscard]] static bool translate(const Known& known, const axes::AxisView& real, axes::AxisView& view) noexcept;
    /// Enters what was answered at once in the ledger, `told` in this latch so far; false when it has been shown already.
    [[nodiscard]] static bool tell(Known& known, std::uint8_t& told, axes::AxisView& view) noexcept;
    template <class Keep>
    void keep_if(Keep keep) noexcept;
    [[nodiscard]] axes::CommandId real_id(axes::CommandId mine) const noexcept;

    std::array<Request, capacity> requests_{};
    std::size_t count_ = 0;
    std::vector<Known> known_;  // oldest first
    std::size_t known_count_ = 0;
    axes::CommandId next_ = 0;
    std::vector<PowerWish> wishes_;  // the task's
    std::vector<PowerWish> held_;    // the cycle's
    std::vector<RefusedReset> resets_;
    std::vector<std::uint8_t> told_;
    std::span<axes::AxisView> views_;
};

}  // namespace taktwerk::runtime
