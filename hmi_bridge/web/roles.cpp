#include "hmi_bridge/web/roles.hpp"

#include <algorithm>

namespace taktwerk::hmi::web {
namespace {

constexpr std::array<std::string_view, 4> role_words{"viewer", "operator", "engineer", "admin"};

}  // namespace

std::string_view word(Role role) { return role_words[static_cast<std::size_t>(role)]; }

std::optional<Role> role_of(std::string_view word) {
    const auto found = std::find(role_words.begin(), role_words.end(), word);
    if (found == role_words.end()) return std::nullopt;
    return static_cast<Role>(found - role_words.begin());
}

const CommandRule* find_rule(std::string_view command) {
    const auto found =
        std::find_if(command_rules.begin(), command_rules.end(), [&](const CommandRule& rule) { return rule.command == command; });
    return found == command_rules.end() ? nullptr : &*found;
}

bool only_asks(const CommandRule& rule) {
    constexpr std::array<std::string_view, 5> of_a_connection{"stop", "group_halt", "scope_arm", "scope_state", "scope_disarm"};
    return !rule.moves && std::find(of_a_connection.begin(), of_a_connection.end(), rule.command) == of_a_connection.end();
}

bool may(Role role, const CommandRule& rule) { return static_cast<int>(role) >= static_cast<int>(rule.least); }

}  // namespace taktwerk::hmi::web
