#include "hmi_bridge/gateway/group_jog_request.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "axes/group/group_words.hpp"
#include "core/nearest_name.hpp"

namespace taktwerk::hmi {
namespace {

/// In which a person may jog: the flange's is none of them.
constexpr std::array frames{axes::mcACS,   axes::mcMCS,   axes::mcWCS,   axes::mcPCS,   axes::mcTCS,   axes::mcPCS_2,
                            axes::mcPCS_3, axes::mcPCS_4, axes::mcPCS_5, axes::mcPCS_6, axes::mcPCS_7, axes::mcPCS_8};
constexpr std::array<std::string_view, 6> components{"x", "y", "z", "rx", "ry", "rz"};
constexpr std::size_t longest_word = 64;

Error bad(std::string what, std::string remedy) { return {"command.bad_value", "", std::move(what), std::move(remedy)}; }

/// A hand's word may be anything: shown short.
std::string quoted(std::string_view text) { return fmt::format("\"{}\"", text.substr(0, longest_word)); }

std::vector<std::string> slots_of(axes::MC_CoordSystem frame, const runtime::MachineLayout& layout,
                                  const runtime::MachineLayout::GroupInfo& group) {
    if (frame != axes::mcACS) return {components.begin(), components.end()};
    std::vector<std::string> names;
    for (const auto member : group.members) names.push_back(member < layout.axes.size() ? layout.axes[member].name : "");
    return names;
}

/// Where a word that is no direction of this frame is one. Empty: nowhere.
std::string other_frame(std::string_view name, axes::MC_CoordSystem frame, const runtime::MachineLayout& layout,
                        const runtime::MachineLayout::GroupInfo& group) {
    const auto known = [&](axes::MC_CoordSystem of) {
        const auto slots = slots_of(of, layout, group);
        return std::find(slots.begin(), slots.end(), name) != slots.end();
    };
    if (frame != axes::mcACS && known(axes::mcACS)) return fmt::format("{} is an axis of it: those are jogged in frame acs.", quoted(name));
    if (frame == axes::mcACS && group.arm && known(axes::mcMCS))
        return fmt::format("{} is a direction of its tool: those are of a frame as mcs (the machine) or tcs (the tool).", quoted(name));
    return {};
}

}  // namespace

Result<runtime::GroupJogOrder> read_group_jog(const GroupJogRequest& request, const runtime::MachineLayout& layout, std::uint16_t group) {
    const auto& info = layout.groups[group];
    if (info.members.empty())
        return Error{"command.not_possible_now", "", "it has no axes by the machine file: its program gives it some",
                     "Name its axes in the file (`members`), or jog them one by one."};
    const auto frame = std::find_if(frames.begin(), frames.end(), [&](auto one) { return name(one) == request.frame; });
    if (frame == frames.end())
        return bad(fmt::format("there is no frame {}", quoted(request.frame)),
                   "Give acs (each axis), mcs (the machine), wcs (the world), pcs or pcs_2 to pcs_8 (a product), or tcs (the tool).");
    if (*frame != axes::mcACS && !info.arm)
        return bad(fmt::format("it has no arm, so nothing of it can be moved in {}", request.frame), "Jog its axes: frame acs.");
    const auto slots = slots_of(*frame, layout, info);
    runtime::GroupJogOrder order;
    order.frame = *frame;
    bool moves = false, turns = false;
    std::string_view rest = request.direction;
    for (;;) {
        rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
        if (rest.empty()) break;
        const auto word = rest.substr(0, rest.find(' '));
        rest.remove_prefix(word.size());
        const auto name = word.substr(0, word.size() - 1);
        const char sign = word.back();
        const auto slot = std::find(slots.begin(), slots.end(), name);
        if ((sign != '+' && sign != '-') || slot == slots.end()) {
            if (const auto elsewhere = other_frame(name, *frame, layout, info); !elsewhere.empty())
                return bad(fmt::format("{} is no direction of it in {}", quoted(word), request.frame), elsewhere);
            const auto near = nearest_name(name.substr(0, longest_word), slots);
            return bad(fmt::format("{} is no direction of it in {}", quoted(word), request.frame),
                       near.empty() ? fmt::format("Give one or more of {}, each with + or - behind it: \"{}+\".", fmt::join(slots, ", "),
                                                  slots.front())
                                    : fmt::format("Did you mean \"{}{}\"?", near, sign == '-' ? '-' : '+'));
        }
        const auto place = static_cast<std::size_t>(slot - slots.begin());
        if (order.frame != axes::mcACS) {
            (place < 3 ? moves : turns) = true;
            // The commanded components are the arm's base's; a frame that is tilted may mix ways with ways, turns with turns.
            const auto& can = info.commands;
            const bool may = place < 3 ? can[0] || can[1] || can[2] : can[3] || can[4] || can[5];
            if (!may) return bad(fmt::format("its arm does not turn its tool, so not in {} either", name), "Give x, y or z.");
        }
        auto& bits = sign == '+' ? order.plus : order.minus;
        bits = static_cast<std::uint16_t>(bits | 1u << place);
    }
    if ((order.plus ^ order.minus) == 0)
        return bad(order.plus == 0 ? "it says no direction" : "both senses of a direction are pressed: nothing is left to move",
                   fmt::format("Give one: \"{}+\".", slots.front()));
    if (!std::isfinite(request.distance) || request.distance < 0)
        return bad(fmt::format("{:g} is no distance", request.distance), "Give a distance above 0; the sign stands with the direction.");
    if (request.distance > 0 && moves && turns)
        return bad("a distance is of ways or of turns, and this jog has both", "Jog one behind the other, or leave the distance out.");
    return order;
}

}  // namespace taktwerk::hmi
