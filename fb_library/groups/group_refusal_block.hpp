#pragma once
// Group_ReadRefusal, ours: what a group has refused last, and where on the path and in the machine it could not be gone. Real-time safe.

#include <cstdint>
#include <string_view>

#include "fb_library/groups/group_block.hpp"

namespace taktwerk::fb {

struct Group_ReadRefusal : GroupReadBlock<Group_ReadRefusal> {
    GroupRef AxesGroup{};
    bool Enable = false;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    std::uint32_t Number = 0;
    ErrorId RefusedID{};
    CommandNumber CommandID{};
    std::uint32_t Line = 0;
    std::uint16_t Room = 0, IdentInGroup = 0;
    double Position = 0, Limit = 0;
    bool OnPath = false;
    double Progress = 0;
    bool InSpace = false;
    double X = 0, Y = 0, Z = 0;

    static constexpr std::string_view summary =
        "Gives what the group has refused last: why, which room or whose limit, and where on the path.";
    static consteval auto pins() {
        return pin_table(
            grouped<&Self::AxesGroup, &Self::Enable>(), reading<Self>(), out<&Self::Number>("", "counts refusals of the group, from 1"),
            out<&Self::RefusedID>("", "why; none: nothing was refused since another motion began"),
            out<&Self::CommandID>("", "of the command; 0: it was refused when it was given"),
            out<&Self::Line>("", "of a stored path's text; 0: none"),
            out<&Self::Room>("", "of the group's workspace, that is entered or left, in the order of the file from 1; 0: none"),
            out<&Self::IdentInGroup>("", "of the axis whose limit it is, or that is not ready; 0: none"),
            out<&Self::Position>("u", "where that axis would go; 0 where nobody knows"), out<&Self::Limit>("u", "its limit"),
            out<&Self::OnPath>("", "Progress is known"), out<&Self::Progress>("1", "0 to 1 of the command's own way, from where it begins"),
            out<&Self::InSpace>("", "X, Y, Z are known"), out<&Self::X>("u", "of the tool's point there, in the machine (mcMCS)"),
            out<&Self::Y>("u", "likewise"), out<&Self::Z>("u", "likewise"));
    }
    [[nodiscard]] Reading read_group(const axes::GroupView& view) noexcept {
        const auto counted = [](std::uint8_t place) {
            return place == axes::PathHindrance::none ? std::uint16_t{0} : std::uint16_t(place + 1);
        };
        const auto& refusal = view.refusal;
        const auto& at = refusal.why.at;
        Number = refusal.number;
        RefusedID = refusal.why.error;
        CommandID = {refusal.id};
        Line = refusal.why.line;
        Room = counted(at.room);
        IdentInGroup = counted(at.place);
        Position = at.position;
        Limit = at.limit;
        OnPath = at.on_path;
        Progress = at.part;
        InSpace = at.in_space;
        X = at.point[0];
        Y = at.point[1];
        Z = at.point[2];
        return Reading::valid();
    }
    void clear() noexcept {
        Number = Line = 0;
        RefusedID = ErrorId::none;
        CommandID = {};
        Room = IdentInGroup = 0;
        Position = Limit = Progress = X = Y = Z = 0;
        OnPath = InSpace = false;
    }
};

}  // namespace taktwerk::fb
