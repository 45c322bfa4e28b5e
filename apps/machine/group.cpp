#include "apps/machine/group.hpp"

#include <memory>
#include <string_view>

#include <fmt/format.h>

#include "apps/machine/override_part.hpp"
#include "apps/machine/remote.hpp"

namespace taktwerk::apps {
namespace {

struct GroupOrder {
    RemoteOptions remote;
    std::string group, percent;
};

struct GroupWord {
    const char *word, *command, *doc, *done;
};
constexpr GroupWord words[] = {
    {"halt", "group_halt", "stop its axes, on the path while it moves; always allowed", "stops on its path"},
    {"interrupt", "group_interrupt", "come to rest on the path and keep the commands", "comes to rest and keeps its commands"},
    {"continue", "group_continue", "go on behind an interrupt", "goes on"},
    {"reset", "group_reset", "its axes leave ErrorStop, then it leaves GroupErrorStop", "resetting"},
    {"enable", "group_enable", "it takes commands; its axes need power", "enabled"},
    {"disable", "group_disable", "stop on the path, then take no commands", "stops, then it is disabled"},
};

int send(const GroupOrder& order, const GroupWord& word) {
    return with_machine(order.remote, [&](hmi::Client& client) {
        const auto answer = client.request({{"cmd", word.command}, {"group", order.group}});
        if (!answer) return report(order.remote, answer.error());
        const auto note = answer->value("note", std::string{});
        if (!note.empty()) return report(order.remote, fmt::format("{}: {}", order.group, note));
        return report(order.remote, fmt::format("{}: {}", order.group, word.done));
    });
}

int set_override(const GroupOrder& order) {
    const auto part = override_part(order.percent);
    if (!part) return report(order.remote, part.error());
    return with_machine(order.remote, [&](hmi::Client& client) {
        const auto answer = client.request({{"cmd", "group_override"}, {"group", order.group}, {"value", *part}});
        if (!answer) return report(order.remote, answer.error());
        return report(order.remote, fmt::format("override of {}: {:g} %", order.group, 100 * *part));
    });
}

}  // namespace

void add_group(CLI::App& app, Action& action) {
    auto* group = app.add_subcommand("group", "axes that move together: halt, interrupt, continue, override, reset, enable, disable");
    group->require_subcommand(1);
    const auto add = [&](const char* word, const char* doc) {
        auto order = std::make_shared<GroupOrder>();
        auto* sub = group->add_subcommand(word, doc);
        add_remote_options(*sub, order->remote);
        sub->add_option("GROUP", order->group, "as the machine file names it")->required();
        return std::pair{sub, order};
    };
    for (const auto& word : words) {
        const auto [sub, order] = add(word.word, word.doc);
        if (word.word == std::string_view("halt")) sub->alias("stop");  // what a hurried hand writes has to stop
        sub->callback([&action, order = order, &word] { action = [order, &word] { return send(*order, word); }; });
    }
    const auto [sub, order] = add("override", "the operator's factor on the velocity along the path; 0 halts");
    sub->add_option("PERCENT", order->percent, "0 to 100")->required();
    sub->callback([&action, order = order] { action = [order] { return set_override(*order); }; });
}

}  // namespace taktwerk::apps
