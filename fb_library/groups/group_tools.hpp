#pragma once
// What the arm carries: tools and payloads by number. MC_GroupWriteToolData, MC_GroupReadToolData, MC_GroupSelectTool, MC_GroupReadTool,
// MC_GroupWritePayloadData, MC_GroupReadPayloadData, MC_GroupSelectPayload, MC_GroupReadPayload. PLCopen Part 4 v2.0. Real-time safe. Number 0 is the flange, or no payload: readable, not writable (G-079). No set-point
// depends on masses.

#include <string_view>

#include "fb_library/groups/group_block.hpp"
#include "fb_library/groups/group_equipment_types.hpp"

namespace taktwerk::fb {

/// Commands that are accepted later have it; one that runs or waits keeps what it took.
struct MC_GroupWriteToolData : GroupCommandBlock<MC_GroupWriteToolData> {
    GroupRef AxesGroup{};
    bool Execute = false;
    std::int16_t ToolNumber = 0;
    MC_TOOL_REF ToolData{};
    MC_ExecutionMode ExecutionMode = mcImmediately;

    bool Done = false, Busy = false, CommandAccepted = false, CommandAborted = false;
    CommandNumber CommandID{};
    bool Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Defines a tool of the group.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(
            grouped<&Self::AxesGroup, &Self::Execute>(), in<&Self::ToolNumber>("", "1 to 31"),
            in<&Self::ToolData>("", "the tool's point, seen from the flange; its mass"), detail::when_set<&Self::ExecutionMode>(),
            out<&Self::Done>("", "later commands have it"),
            grouped<&Self::Busy, &Self::CommandAccepted, &Self::CommandAborted, &Self::CommandID, &Self::Error, &Self::ErrorID>());
    }
    [[nodiscard]] axes::GroupCommand command() const noexcept {
        return {.kind = axes::GroupCommandKind::write_tool,
                .execution = ExecutionMode,
                .number = detail::number_of(ToolNumber),
                .tool = {detail::six_of(ToolData.ToolFrame), detail::written_of(ToolData.RigidBodyDynamic)}};
    }
};

struct MC_GroupReadToolData : EnableBlock<MC_GroupReadToolData> {
    GroupRef AxesGroup{};
    bool Enable = false;
    std::int16_t ToolNumber = 0;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    MC_TOOL_REF ToolData{};

    static constexpr std::string_view summary = "Gives a tool of the group as it was written.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable>(), in<&Self::ToolNumber>("", "0 to 31; 0 is the flange"), reading<Self>(),
                         out<&Self::ToolData>("", "the tool's point, seen from the flange; its mass"));
    }
    [[nodiscard]] Reading read(const MotionContext& ctx) noexcept {
        const auto* known = detail::equipment_of(ctx, AxesGroup);
        if (known == nullptr) return Reading::unless(ErrorId::invalid_group);
        const auto* tool = known->tools.find(detail::number_of(ToolNumber));
        if (tool == nullptr) return Reading::unless(ErrorId::invalid_tool);
        ToolData = {detail::coordinates_of(tool->frame), detail::pin_of(tool->body)};
        return Reading::valid();
    }
    void clear() noexcept { ToolData = {}; }
};

struct MC_GroupSelectTool : GroupSettingBlock<MC_GroupSelectTool> {
    GroupRef AxesGroup{};
    bool Execute = false;
    std::int16_t ToolNumber = 0;

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Says whose point the next commands move.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Execute>(), in<&Self::ToolNumber>("", "0 to 31; 0 is the flange"),
                         out<&Self::Done>("", "later commands have it"), grouped<&Self::Busy, &Self::Error, &Self::ErrorID>());
    }
    [[nodiscard]] axes::GroupSetting setting() const noexcept { return axes::SelectTool{detail::number_of(ToolNumber)}; }
};

/// Without a running command the active tool is the selected one.
struct MC_GroupReadTool : EnableBlock<MC_GroupReadTool> {
    GroupRef AxesGroup{};
    bool Enable = false;
    MC_ToolSource ToolSource = MC_ToolSource::mcActive;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    std::int16_t ToolNumber = 0;

    static constexpr std::string_view summary = "Gives whose point moves now, or with the next command.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable>(),
                         in<&Self::ToolSource>("", "of the running command, or for the next one"), reading<Self>(),
                         out<&Self::ToolNumber>("", "0 is the flange"));
    }
    [[nodiscard]] Reading read(const MotionContext& ctx) noexcept {
        const auto* known = detail::equipment_of(ctx, AxesGroup);
        if (known == nullptr) return Reading::unless(ErrorId::invalid_group);
        ToolNumber = ToolSource == MC_ToolSource::mcActive ? known->active_tool : known->selected_tool;
        return Reading::unless(ToolSource > MC_ToolSource::mcSelected ? ErrorId::invalid_parameter : ErrorId::none);
    }
    void clear() noexcept { ToolNumber = 0; }
};

struct MC_GroupWritePayloadData : GroupSettingBlock<MC_GroupWritePayloadData> {
    GroupRef AxesGroup{};
    bool Execute = false;
    std::int16_t PayloadNumber = 0;
    MC_RIGID_BODY_DYNAMIC_REF PayloadData{};

    bool CommandAborted = false, Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Defines a payload of the group.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Execute>(), in<&Self::PayloadNumber>("", "1 to 31"),
                         in<&Self::PayloadData>("", "in the frame of the tool's point; kg, u, kg m2"),
                         out<&Self::CommandAborted>("", "never: it is written at once"), out<&Self::Done>("", "written"),
                         grouped<&Self::Busy, &Self::Error, &Self::ErrorID>());
    }
    [[nodiscard]] axes::GroupSetting setting() const noexcept {
        return axes::WritePayload{detail::number_of(PayloadNumber), detail::written_of(PayloadData)};
    }
};

struct MC_GroupReadPayloadData : EnableBlock<MC_GroupReadPayloadData> {
    GroupRef AxesGroup{};
    bool Enable = false;
    std::int16_t PayloadNumber = 0;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    MC_RIGID_BODY_DYNAMIC_REF PayloadData{};

    static constexpr std::string_view summary = "Gives a payload of the group as it was written.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable>(), in<&Self::PayloadNumber>("", "0 to 31; 0 is none"), reading<Self>(),
                         out<&Self::PayloadData>("", "in the frame of the tool's point; kg, u, kg m2"));
    }
    [[nodiscard]] Reading read(const MotionContext& ctx) noexcept {
        const auto* known = detail::equipment_of(ctx, AxesGroup);
        if (known == nullptr) return Reading::unless(ErrorId::invalid_group);
        const auto* body = known->payloads.find(detail::number_of(PayloadNumber));
        if (body == nullptr) return Reading::unless(ErrorId::invalid_tool);
        PayloadData = detail::pin_of(*body);
        return Reading::valid();
    }
    void clear() noexcept { PayloadData = {}; }
};

struct MC_GroupSelectPayload : GroupSettingBlock<MC_GroupSelectPayload> {
    GroupRef AxesGroup{};
    bool Execute = false;
    std::int16_t PayloadNumber = 0;

    bool CommandAborted = false, Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Says what the arm carries with the next commands.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Execute>(), in<&Self::PayloadNumber>("", "0 to 31; 0 is none"),
                         out<&Self::CommandAborted>("", "never: it is selected at once"), out<&Self::Done>("", "later commands have it"),
                         grouped<&Self::Busy, &Self::Error, &Self::ErrorID>());
    }
    [[nodiscard]] axes::GroupSetting setting() const noexcept { return axes::SelectPayload{detail::number_of(PayloadNumber)}; }
};

struct MC_GroupReadPayload : EnableBlock<MC_GroupReadPayload> {
    GroupRef AxesGroup{};
    bool Enable = false;
    MC_ToolSource PayloadSource = MC_ToolSource::mcActive;

    bool CommandAborted = false, Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    std::int16_t PayloadNumber = 0;

    static constexpr std::string_view summary = "Gives what the arm carries now, or with the next command.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(
            grouped<&Self::AxesGroup, &Self::Enable>(), in<&Self::PayloadSource>("", "of the running command, or for the next one"),
            out<&Self::CommandAborted>("", "never: it only reads"), reading<Self>(), out<&Self::PayloadNumber>("", "0 is none"));
    }
    [[nodiscard]] Reading read(const MotionContext& ctx) noexcept {
        const auto* known = detail::equipment_of(ctx, AxesGroup);
        if (known == nullptr) return Reading::unless(ErrorId::invalid_group);
        PayloadNumber = PayloadSource == MC_ToolSource::mcActive ? known->active_payload : known->selected_payload;
        return Reading::unless(PayloadSource > MC_ToolSource::mcSelected ? ErrorId::invalid_parameter : ErrorId::none);
    }
    void clear() noexcept { PayloadNumber = 0; }
};

}  // namespace taktwerk::fb
