// Man pages and completion say what the command takes; a page that a reader of man pages or a shell cannot take is none.

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/docs/command_pages.hpp"
#include "apps/taktwerk.hpp"
#include "apps/terminal/exit_code.hpp"
#include "tests/apps/child.hpp"
#include "tests/apps/in_process.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

struct Pages : ::testing::Test {
    Pages() {
        root.require_subcommand(1);
        add_run(root, action), add_bus(root, action), add_retain(root, action), add_status(root, action), add_docs(root, action);
    }
    CLI::App root{"Taktwerk"};
    Action action;
};

TEST_F(Pages, HaveEveryCommandAndEveryOption) {
    const auto pages = man_pages(root, "1.2.3");
    ASSERT_EQ(pages.size(), 6u);
    EXPECT_EQ(pages[0].first, "taktwerk.1");
    for (const auto* sub : root.get_subcommands([](const CLI::App*) { return true; })) {
        const auto page = std::ranges::find(pages, "taktwerk-" + sub->get_name() + ".1", [](const auto& p) { return p.first; });
        ASSERT_NE(page, pages.end()) << sub->get_name();
        EXPECT_THAT(pages[0].second, HasSubstr("\\fB" + sub->get_name() + "\\fR")) << "it stands in the front page";
        for (const auto* option : sub->get_options())
            for (auto name : option->get_lnames()) {
                for (std::size_t at = 0; (at = name.find('-', at)) != std::string::npos; at += 2) name.replace(at, 1, "\\-");
                EXPECT_THAT(page->second, HasSubstr("\\-\\-" + name)) << sub->get_name();
            }
        for (const auto* command : sub->get_subcommands([](const CLI::App*) { return true; }))
            EXPECT_THAT(page->second, HasSubstr(sub->get_name() + " " + command->get_name()));
    }
}

// In man(7) a line that begins with a dot or an apostrophe is a request, and a backslash an escape.
TEST_F(Pages, DescriptionsAreNoRequests) {
    CLI::App odd{"odd"};
    auto* sub = odd.add_subcommand("odd", ".so /etc/passwd");
    sub->add_option("--back", "a \\ backslash and a \"quote\"");
    const auto page = man_pages(odd, "1")[1].second;
    EXPECT_THAT(page, HasSubstr("a \\e backslash"));
    EXPECT_THAT(page, ::testing::Not(HasSubstr("\n.so")));
}

TEST_F(Pages, TheCompletionIsAScriptThatCompletes) {
    auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-completion-XXXXXX").string();
    const std::filesystem::path folder = ::mkdtemp(pattern.data());
    const auto script = (folder / "taktwerk").string();
    std::ofstream(script) << bash_completion(root);
    const auto completed = [&](const std::string& words, int at) {
        Child bash({"bash", "-c",
                    "set -u; . " + script + "; COMP_WORDS=(" + words + "); COMP_CWORD=" + std::to_string(at) +
                        "; cd /; _taktwerk; printf '%s|' \"${COMPREPLY[@]}\""});
        EXPECT_EQ(bash.wait(10s), 0) << bash.text();
        return bash.text();
    };
    EXPECT_EQ(completed("taktwerk ret", 1), "retain|");
    EXPECT_EQ(completed("taktwerk retain ex", 2), "export|");
    EXPECT_EQ(completed("taktwerk run --virt", 2), "--virtual-time|");
    EXPECT_EQ(completed("taktwerk run --start co", 3), "cold|");
    EXPECT_EQ(completed("taktwerk run et", 2), "etc|") << "a file";
    EXPECT_EQ(completed("taktwerk run --nothing", 2), "|");
    std::filesystem::remove_all(folder);
}

// What people type before they have read anything.
TEST(Help, IsACommandToo) {
    const auto all = in_process({"help"});
    EXPECT_EQ(all.code, exit_ok);
    EXPECT_THAT(all.out, HasSubstr("monitor"));
    const auto one = in_process({"help", "group", "halt"});
    EXPECT_EQ(one.code, exit_ok);
    EXPECT_EQ(one.out, in_process({"group", "halt", "--help"}).out);
    EXPECT_EQ(in_process({"help", "grop"}).code, exit_usage);
}

// Who is in a hurry to stop a group does not look up what that is called.
TEST(Help, AGroupIsStoppedByThatWord) {
    const auto halt = in_process({"group", "halt", "arm", "-s", "/nowhere/there.is.none"});
    const auto stop = in_process({"group", "stop", "arm", "-s", "/nowhere/there.is.none"});
    EXPECT_EQ(stop.code, exit_no_runtime);
    EXPECT_EQ(stop.err, halt.err);
}

}  // namespace
}  // namespace taktwerk::apps
