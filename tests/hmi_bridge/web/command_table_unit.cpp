// No command of the local socket was forgotten in the page's table of roles: each stands there, or here as one that comes from no page.

#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hmi_bridge/command_words.hpp"
#include "hmi_bridge/web/roles.hpp"

namespace taktwerk::hmi::web {
namespace {

/// Deliberately absent, with the reason.
const std::set<std::string> from_no_page{};

/// The first column of the table `| cmd | keys |` of hmi_bridge/README.md, which its own readers keep complete.
std::set<std::string> documented_commands() {
    std::ifstream in(std::string(TAKTWERK_SOURCE_DIR) + "/hmi_bridge/README.md");
    std::set<std::string> commands;
    bool inside = false;
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with("| `cmd` | keys")) inside = true;
        else if (inside && !line.starts_with("|")) break;
        if (!inside || line.starts_with("| `cmd`")) continue;
        std::istringstream column(line.substr(1, line.find('|', 1) - 1));
        for (std::string word; std::getline(column, word, '`');)
            if (!word.empty() && word.find_first_not_of("abcdefghijklmnopqrstuvwxyz_") == std::string::npos) commands.insert(word);
    }
    return commands;
}

TEST(CommandTable, EveryCommandOfTheSocketStandsInIt) {
    const auto commands = documented_commands();
    EXPECT_GE(commands.size(), 25u) << "else the table was not read";
    for (const auto& command : commands)
        EXPECT_TRUE(find_rule(command) != nullptr || from_no_page.count(command) != 0)
            << command << ": give it a row in hmi_bridge/web/roles.hpp";
    for (const auto& word : command_words) EXPECT_NE(find_rule(word.word), nullptr) << word.word;
}

TEST(CommandTable, EveryRowIsACommandOfTheSocketOnce) {
    const auto commands = documented_commands();
    std::set<std::string> seen;
    for (const auto& rule : command_rules) {
        EXPECT_EQ(commands.count(std::string(rule.command)), 1u) << rule.command << ": the socket's table in hmi_bridge/README.md lacks it";
        EXPECT_TRUE(seen.insert(std::string(rule.command)).second) << rule.command << " stands twice";
    }
}

// What may begin a motion or change something is nobody's who only looks; a stop is everybody's.
TEST(CommandTable, AViewerLooksAndStops) {
    for (const auto& rule : command_rules) {
        if (rule.least == Role::viewer) {
            EXPECT_FALSE(rule.moves) << rule.command;
        }
    }
    for (const auto& word : command_words)
        EXPECT_EQ(find_rule(word.word)->least == Role::viewer, word.word == "stop" || word.word == "group_halt") << word.word;
    EXPECT_EQ(find_rule("stop")->least, Role::viewer);
}

// Over the connection of all pages goes what neither moves nor belongs to one of them: a trigger ends with its connection, a stop waits for nobody's turn.
TEST(CommandTable, WhatOnlyAsksMovesNothing) {
    for (const auto& rule : command_rules) {
        if (only_asks(rule)) {
            EXPECT_FALSE(rule.moves) << rule.command;
        }
    }
    for (const char* one : {"stop", "group_halt", "scope_arm", "scope_state", "scope_disarm", "jog", "set_value"})
        EXPECT_FALSE(only_asks(*find_rule(one))) << one;
    for (const char* one : {"state", "drive_read", "scope_read", "log", "measure_plan"}) EXPECT_TRUE(only_asks(*find_rule(one))) << one;
}

}  // namespace
}  // namespace taktwerk::hmi::web
