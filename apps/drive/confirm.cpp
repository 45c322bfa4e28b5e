// What is not done without a yes: of `drive set`, writes that are no settings; of `drive clear-turns`, itself.

#include <algorithm>
#include <iostream>
#include <string>

#include <unistd.h>

#include <fmt/format.h>

#include "apps/drive/drive.hpp"
#include "axes/port/parameter_text.hpp"

namespace taktwerk::apps {

namespace {

using axes::DriveOrder;
using axes::DriveParameter;

constexpr std::uint16_t store_parameters = 0x1010, restore_parameters = 0x1011;  // CiA 301 7.5.2.13, 7.5.2.14

std::optional<DriveOrder> order_of(const axes::DriveProfile& profile, const DriveParameter& parameter) {
    for (const auto& row : profile.orders)
        if (row.address == parameter.address) return row.order;
    if (parameter.address.index == store_parameters) return DriveOrder::save_parameters;
    if (parameter.address.index == restore_parameters) return DriveOrder::restore_parameters;
    return std::nullopt;
}

/// The command that does the same with care; empty: there is none.
std::string way_with_care(const DriveAccess& drive, const DriveParameter& parameter) {
    const auto& profile = drive.profile();
    if (profile.encoder.clear_turns.index != 0 && profile.encoder.clear_turns == parameter.address)
        return fmt::format("`taktwerk drive clear-turns {}` clears the turns, and the machine knows that the axis lost its reference",
                           drive.word());
    switch (order_of(profile, parameter).value_or(DriveOrder::emergency_stop)) {
        case DriveOrder::save_parameters: return fmt::format("`taktwerk drive set {} PARAMETER=VALUE --store` stores", drive.word());
        case DriveOrder::restore_parameters:
            return fmt::format("first `taktwerk drive save {} FILE`, so that `taktwerk drive restore` can bring back what is there now",
                               drive.word());
        case DriveOrder::reset_alarm: return fmt::format("`taktwerk drive reset {}` resets a fault", drive.word());
        case DriveOrder::emergency_stop: break;
    }
    return {};
}

}  // namespace

std::optional<Error> needs_a_yes(const DriveAccess& drive, const std::vector<config::ParameterSet::Value>& values) {
    std::string what, ways;
    for (const auto& value : values) {
        const auto& parameter = *value.parameter;
        if (axes::is_setting(parameter) || drive.guards(parameter)) continue;
        what += fmt::format("{}{} ({}) is no setting: the drive does something when it is written{}", what.empty() ? "" : "; ",
                            axes::name_of(parameter), parameter.name,
                            parameter.meaning.empty() ? std::string{} : fmt::format(" ({})", parameter.meaning));
        if (const auto way = way_with_care(drive, parameter); !way.empty() && ways.find(way) == std::string::npos)
            ways += (ways.empty() ? "" : "; ") + way;
    }
    if (what.empty()) return std::nullopt;
    return Error{"drive.not_confirmed", drive.subject(), what,
                 fmt::format("{}see in the manual what it does, and say --yes if that is meant", ways.empty() ? ways : ways + "; else ")};
}

Result<void> confirm(const DriveAccess& drive, const Error& refusal, bool yes) {
    if (yes) return {};
    if (::isatty(STDIN_FILENO) == 0) return refusal;
    fmt::print(stderr, "{}: {}. Go on? [y/N] ", refusal.subject, refusal.what);
    std::string answer;
    std::getline(std::cin, answer);
    if (answer == "y" || answer == "Y" || answer == "yes") return {};
    return Error{"drive.not_confirmed", drive.subject(), "nothing was done", ""};
}

}  // namespace taktwerk::apps
