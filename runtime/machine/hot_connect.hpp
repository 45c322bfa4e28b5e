#pragma once
// Which groups of hot connect are there, told to their axes; and the alarm of one that was taken away under power. Real-time safe but for the
// constructor.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/machine/machine_body.hpp"
#include "runtime/machine/machine_drives.hpp"

namespace taktwerk::runtime {

class HotConnect {
public:
    HotConnect(MachineBody& body, const MachineDrives& drives);

    /// What the bus says now, before the axes look at their drives.
    void step() noexcept;
    /// Alarms of groups that have gone since the last call.
    void watch() noexcept;
    /// The feedback of this axis is away because its group is, or it is not known yet whether that is so: the alarm of the group will say it, or it
    /// came back already.
    [[nodiscard]] bool speaks_for(std::size_t axis) const noexcept;
    /// Name of the axis' group; empty: it is in none.
    [[nodiscard]] std::string_view group_of(std::size_t axis) const noexcept;

private:
    struct Member {
        std::size_t axis;
        int group;
        Instant online{};  // last
    };
    struct Pulled {
        std::uint16_t axis = 0;  // the first of those that had power
        std::uint16_t axes = 0;  // so many
    };
    [[nodiscard]] const Member* find(std::size_t axis) const noexcept;

    MachineBody& body_;
    std::vector<std::string> names_;
    std::vector<Member> members_;
    std::vector<Pulled> pulled_;  // by group
};

}  // namespace taktwerk::runtime
