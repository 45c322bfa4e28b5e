#include "tests/troubles/trouble.hpp"

#include <algorithm>
#include <regex>

#include "tests/troubles/bench.hpp"
#include "tests/troubles/own_network.hpp"

namespace taktwerk::troubles {

namespace {

struct Phrase {
    std::string_view words;
    Culprit culprit;
    std::string_view who;
    bool in_remedy = false;  ///< there it points at him, too; else it only says to whom the cable belongs
};
constexpr Phrase phrases[] = {
    {"another master", Culprit::other_master, "another master"},          {"other master", Culprit::other_master, "another master"},
    {"another EtherCAT master", Culprit::other_master, "another master"}, {"second controller", Culprit::other_master, "another master"},
    {"Somebody else", Culprit::other_master, "another master"},           {"foreign_master", Culprit::other_master, "another master", true},
    {"this computer", Culprit::this_computer, "this computer"},           {"This computer", Culprit::this_computer, "this computer"},
    {"late_wakeups", Culprit::this_computer, "this computer", true}};

/// Letters of the slaves that a text names, by name or by position.
std::string slaves_in(const std::string& text) {
    static const std::regex by_name{"'([a-z])'"}, by_position{"slave ([0-9]+)"};
    std::string letters;
    for (std::sregex_iterator at{text.begin(), text.end(), by_name}, end; at != end; ++at) letters += at->str(1);
    for (std::sregex_iterator at{text.begin(), text.end(), by_position}, end; at != end; ++at)
        letters += static_cast<char>('a' + std::stoi(at->str(1)));
    std::sort(letters.begin(), letters.end());
    letters.erase(std::unique(letters.begin(), letters.end()), letters.end());
    return letters;
}

}  // namespace

std::vector<Chapter> chapters() {
    return {network_port(),      wrong_slaves(),    wrong_cables(),      wrong_settings(),     refused_states(),
            refused_mailboxes(), lost_on_the_way(), lost_in_operation(), unwell_in_operation()};
}

std::vector<Trouble> all_troubles() {
    std::vector<Trouble> all;
    for (auto& chapter : chapters()) all.insert(all.end(), chapter.troubles.begin(), chapter.troubles.end());
    return all;
}

bool can_be_staged(const Trouble& trouble) {
    const bool needs_network = trouble.opens != nullptr || trouble.before == put_behind_port;
    return !needs_network || own_network_possible();
}

std::vector<Said> staged(const Trouble& trouble) {
    if (trouble.opens != nullptr) return {trouble.opens()};
    Bench bench{trouble.configured, trouble.there};
    if (trouble.before != nullptr) trouble.before(bench);
    switch (trouble.teller) {
        case Teller::check: return bench.what_check_says();
        case Teller::scan: return bench.what_scan_says();
        case Teller::why: return bench.what_why_says();
        case Teller::port:
        case Teller::alarm: break;
    }
    if (!bench.bring_up()) return {{"did not reach OP", "", bench.why(), "", {}}};
    bench.run_for(300ms);
    if (!bench.faults().empty()) return {{"is not well before the trouble", "", bench.why(), "", {}}};
    trouble.strikes(bench);
    return bench.what_alarms_say(trouble.patience);
}

std::vector<std::string> accused(const Trouble& trouble, const Said& said) {
    std::vector<std::string> innocent;
    const std::string told = said.place + " " + said.cause, all = told + " " + said.remedy;
    for (const char slave : slaves_in(all))
        if (trouble.named.find(slave) == std::string_view::npos) innocent.emplace_back(1, slave);
    for (const auto& phrase : phrases)
        if (phrase.culprit != trouble.culprit && (phrase.in_remedy ? all : told).find(phrase.words) != std::string::npos)
            innocent.emplace_back(phrase.who);
    return innocent;
}

}  // namespace taktwerk::troubles
