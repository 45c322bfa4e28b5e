#pragma once
// Which way a group is to be jogged, as people write it: a frame's word and directions, "x+", "x+ y-", "shoulder+". Not real-time.

#include <cstdint>
#include <string>
#include <string_view>

#include "core/result.hpp"
#include "runtime/operator_command.hpp"
#include "runtime/snapshot.hpp"

namespace taktwerk::hmi {

struct GroupJogRequest {
    std::string frame =
        "mcs";  ///< acs (each axis), mcs (the machine), wcs (the world), pcs, pcs_2 to pcs_8 (products), tcs (the tool as it stands)
    std::string direction;  ///< blanks between; in acs names of its axes, else x y z rx ry rz; each with + or - behind it
    double distance = 0;    ///< in the group's unit, of turns in degrees, in acs in the axis' unit; 0: as long as it is held
    friend bool operator==(const GroupJogRequest&, const GroupJogRequest&) = default;
};

/// Errors: command.bad_value (a frame, direction or distance that is none, a distance of ways and turns together, a direction that this arm does not
/// turn in), command.not_possible_now (the group has no axes by its configuration: nobody could be kept from jogging the same axes).
[[nodiscard]] Result<runtime::GroupJogOrder> read_group_jog(const GroupJogRequest& request, const runtime::MachineLayout& layout,
                                                            std::uint16_t group);

}  // namespace taktwerk::hmi
