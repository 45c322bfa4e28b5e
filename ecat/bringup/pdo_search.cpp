#include "ecat/bringup/pdo_search.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ecat/bringup/effective_pdos.hpp"
#include "ecat/bringup/pdo_objects.hpp"
#include "ecat/bringup/slave_objects.hpp"
#include "ecat/coe/sdo_client.hpp"

namespace taktwerk::ecat {

namespace {

using Pdos = std::vector<PdoDescription>;

constexpr std::uint16_t first_rx = 0x1600, first_tx = 0x1A00;
constexpr std::uint16_t ranges[] = {0x000, 0x100};  // the usual place, and that of several makers for their fixed ones
constexpr std::uint16_t looked_at = 16;             // of each range
constexpr std::size_t most_together = 4;            // PDOs

bool same_object(const PdoEntry& a, const PdoEntry& b) noexcept { return a.index == b.index && a.sub == b.sub; }

bool has(const Pdos& pdos, const PdoEntry& object) {
    return std::ranges::any_of(pdos, [&](const auto& pdo) {
        return std::ranges::any_of(pdo.entries, [&](const auto& entry) { return same_object(entry, object); });
    });
}

bool has_all(const Pdos& pdos, const std::vector<PdoEntry>& objects) {
    return std::ranges::all_of(objects, [&](const auto& object) { return has(pdos, object); });
}

std::vector<PdoEntry> lacking(const Pdos& pdos, const std::vector<PdoEntry>& objects) {
    std::vector<PdoEntry> out;
    for (const auto& object : objects)
        if (!has(pdos, object)) out.push_back(object);
    return out;
}

std::vector<PdoEntry> entries_of(const Pdos& pdos) {
    std::vector<PdoEntry> out;
    for (const auto& pdo : pdos) out.insert(out.end(), pdo.entries.begin(), pdo.entries.end());
    return out;
}

/// What they carry of the wish; an object counts more than all behind it.
std::uint64_t worth(const Pdos& pdos, const PdoWish& wish) {
    std::uint64_t sum = 0;
    for (const auto& object : wish.pdo.entries) sum = 2 * sum + (has(pdos, object) ? 1 : 0);
    return sum;
}

std::string names(const std::vector<PdoEntry>& objects) {
    std::string out;
    for (const auto& object : objects)
        if (object.index != 0)
            out += fmt::format("{}{:04X}h{}", out.empty() ? "" : " ", object.index, object.sub ? fmt::format(":{:02X}", object.sub) : "");
    return out;
}

std::string names(const Pdos& pdos) {
    std::string out;
    for (const auto& pdo : pdos) out += fmt::format("{}{:04X}h ({})", out.empty() ? "" : ", ", pdo.index, names(pdo.entries));
    return out.empty() ? "none" : out;
}

bool refused(const Error& error) { return error.code == "sdo.abort"; }

/// The search in one direction of one slave: what it learns on the way.
struct Search {
    Bus& bus;
    BusSlave& slave;
    std::uint16_t assignment;
    PdoWish wish;
    bool assignable = true;  ///< the assignment object can be written
    std::string refusal{};   ///< the last thing that it did not take
    [[nodiscard]] bool out() const noexcept { return wish.pdo.index < first_tx; }
};

/// Entry by entry: what is refused is left out. Nothing where the PDO's content cannot be written at all.
Script<Result<std::optional<PdoDescription>>> fill(Search& search) {
    PdoDescription taken;
    taken.index = search.wish.pdo.index;
    Result<void> written = co_await write_number(search.bus, search.slave, taken.index, 0, 0, 1);
    if (!written) {
        if (!refused(written.error())) co_return written.error();
        search.refusal = written.error().what;
        co_return std::optional<PdoDescription>{};
    }
    for (const auto& entry : search.wish.pdo.entries) {
        const auto place = static_cast<std::uint8_t>(taken.entries.size() + 1);
        written = co_await write_number(search.bus, search.slave, taken.index, place, mapped_as(entry), 4);
        if (written) {
            taken.entries.push_back(entry);
            continue;
        }
        if (!refused(written.error())) co_return written.error();
        search.refusal = written.error().what;
    }
    // Some count bytes and entries only now.
    while (!taken.entries.empty()) {
        written = co_await write_number(search.bus, search.slave, taken.index, 0, static_cast<std::uint32_t>(taken.entries.size()), 1);
        if (written) co_return std::optional<PdoDescription>{std::move(taken)};
        if (!refused(written.error())) co_return written.error();
        search.refusal = written.error().what;
        taken.entries.pop_back();
    }
    co_return std::optional<PdoDescription>{};
}

Script<Result<Pdos>> read_all(Search& search, const std::vector<std::uint16_t>& numbers) {
    Pdos pdos;
    for (const std::uint16_t number : numbers) {
        Result<PdoDescription> pdo = co_await read_mapping(search.bus, search.slave, number);
        if (!pdo && !refused(pdo.error())) co_return pdo.error();
        if (pdo && !pdo->entries.empty()) pdos.push_back(std::move(*pdo));
    }
    co_return pdos;
}

/// What is assigned, in its own words; a PDO whose content it does not show has that of its EEPROM. Nothing: it does not say.
Script<Result<std::optional<Pdos>>> read_assigned(Search& search) {
    const Result<std::vector<std::uint16_t>> numbers = co_await read_assignment(search.bus, search.slave, search.assignment);
    if (!numbers && !refused(numbers.error())) co_return numbers.error();
    if (!numbers) co_return std::optional<Pdos>{};
    const Pdos in_eeprom = assigned_in_eeprom(search.out() ? search.slave.found.sii.rx_pdos : search.slave.found.sii.tx_pdos);
    Pdos pdos;
    for (const std::uint16_t number : *numbers) {
        Result<PdoDescription> pdo = co_await read_mapping(search.bus, search.slave, number);
        if (!pdo && !refused(pdo.error())) co_return pdo.error();
        const auto* hidden = pdo ? nullptr : find_pdo(in_eeprom, number);
        if (!pdo && hidden == nullptr) co_return std::optional<Pdos>{};  // it would be left out of the frames
        if (hidden != nullptr) pdos.push_back(*hidden);
        else if (!pdo->entries.empty()) pdos.push_back(std::move(*pdo));
    }
    co_return std::optional<Pdos>{std::move(pdos)};
}

/// The fewest of its PDOs that have what is required: one if one has, else one after the other.
Pdos choose(const Pdos& offered, const PdoWish& wish) {
    Pdos best;
    for (const auto& pdo : offered)
        if (has_all({pdo}, wish.required) && (best.empty() || worth({pdo}, wish) > worth(best, wish))) best = {pdo};
    while (!has_all(best, wish.required) && best.size() < most_together) {
        const PdoDescription* next = nullptr;
        std::uint64_t most = worth(best, wish);
        for (const auto& pdo : offered) {
            // The same object twice would be written twice in a frame.
            if (std::ranges::any_of(pdo.entries, [&](const auto& entry) { return entry.index != 0 && has(best, entry); })) continue;
            auto with = best;
            with.push_back(pdo);
            if (worth(with, wish) <= most) continue;
            most = worth(with, wish);
            next = &pdo;
        }
        if (next == nullptr) return {};
        best.push_back(*next);
    }
    return best;
}

Error nothing_fits(const Search& search, const Pdos& pdos) {
    const bool out = search.wish.pdo.index < first_tx;
    return Error{
        "bus.no_process_data", search.slave.subject,
        fmt::format("{} cannot be exchanged: its {} are {}{}", names(lacking(pdos, search.wish.required)), out ? "RxPDOs" : "TxPDOs",
                    names(pdos), search.refusal.empty() ? std::string{} : fmt::format("; it takes no other mapping: {}", search.refusal)),
        "look up in its manual how the object is mapped, and say so in a drive file of its own (`based_on`, docs/drives.md)"};
}

/// Written and read back: what it shows then is what is exchanged, whatever it accepted. Nothing: it refuses the assignment.
Script<Result<std::optional<Pdos>>> assign(Search& search, const Pdos& pdos) {
    if (search.assignable) {
        const Result<void> written = co_await write_assigned(search.bus, search.slave, search.assignment, pdos);
        if (!written) {
            if (!refused(written.error())) co_return written.error();
            search.refusal = written.error().what;
            co_return std::optional<Pdos>{};
        }
    }
    Result<std::optional<Pdos>> shown = co_await read_assigned(search);
    if (!shown) co_return shown.error();
    if (!*shown) co_return std::optional<Pdos>{pdos};
    if (has_all(**shown, search.wish.required)) co_return std::optional<Pdos>{std::move(**shown)};
    if (search.refusal.empty()) search.refusal = "it accepted another and does not show it";
    co_return nothing_fits(search, **shown);
}

/// Of its own PDOs, where it takes none of ours. `but`: the one that it refused to have assigned; 0: none.
Script<Result<Pdos>> choose_own(Search& search, std::uint16_t but) {
    if (!search.assignable) {
        Result<std::optional<Pdos>> now = co_await read_assigned(search);
        if (!now) co_return now.error();
        if (!*now || !has_all(**now, search.wish.required)) co_return nothing_fits(search, *now ? **now : Pdos{});
        co_return std::move(**now);
    }
    std::vector<std::uint16_t> numbers;
    for (const auto range : ranges)
        for (std::uint16_t n = 0; n < looked_at; ++n)
            if (const auto number = static_cast<std::uint16_t>((search.out() ? first_rx : first_tx) + range + n); number != but)
                numbers.push_back(number);
    search.bus.note(search.slave, fmt::format("looking which PDOs it has for {:04X}h", search.assignment));
    Result<Pdos> offered = co_await read_all(search, numbers);
    if (!offered) co_return offered.error();
    const Pdos chosen = choose(*offered, search.wish);
    if (!has_all(chosen, search.wish.required) || chosen.empty()) co_return nothing_fits(search, *offered);
    Result<std::optional<Pdos>> assigned = co_await assign(search, chosen);
    if (!assigned) co_return assigned.error();
    if (!*assigned) co_return nothing_fits(search, *offered);
    co_return std::move(**assigned);
}

/// What was there before a mapping that did not become one.
Script<Result<void>> restore(Search& search, const Result<PdoDescription>& before) {
    if (!before) co_return Result<void>{};
    const Result<void> written = co_await write_mapping(search.bus, search.slave, *before);
    if (!written && !refused(written.error())) co_return written.error();
    co_return Result<void>{};
}

Script<Result<Pdos>> look_for(Search& search) {
    Result<std::optional<Pdos>> now = co_await read_assigned(search);
    if (!now) co_return now.error();
    if (*now && has_all(**now, search.wish.pdo.entries)) co_return std::move(**now);

    const Result<void> cleared = co_await write_number(search.bus, search.slave, search.assignment, 0, 0, 1);
    if (!cleared) {
        if (!refused(cleared.error())) co_return cleared.error();
        search.assignable = false;
        search.refusal = cleared.error().what;
        if (*now && (*now)->size() == 1) search.wish.pdo.index = (*now)->front().index;  // its content may be free all the same
    }
    const Result<PdoDescription> before = co_await read_mapping(search.bus, search.slave, search.wish.pdo.index);
    if (!before && !refused(before.error())) co_return before.error();
    const Result<std::optional<PdoDescription>> filled = co_await fill(search);
    if (!filled) co_return filled.error();
    Pdos taken;
    if (*filled) taken.push_back(**filled);
    if (has_all(taken, search.wish.required)) {
        Result<std::optional<Pdos>> assigned = co_await assign(search, taken);
        if (!assigned) co_return assigned.error();
        if (*assigned) co_return std::move(**assigned);
        co_return co_await choose_own(search, search.wish.pdo.index);
    }
    const Result<void> restored = co_await restore(search, before);
    if (!restored) co_return restored.error();
    co_return co_await choose_own(search, 0);
}

/// Outputs that nobody asked for go out with every frame all the same: a torque limit or a highest speed of zero would mean "never move". They
/// begin with what the drive has in them now.
Script<Result<void>> keep_outputs(Search& search, const Pdos& pdos) {
    search.slave.kept.clear();
    const Pdos asked{search.wish.pdo};
    const std::vector<PdoEntry> others = lacking(asked, entries_of(pdos));
    for (const auto& object : others) {
        if (object.index == 0) continue;
        const Result<std::uint32_t> value = co_await read_number(search.bus, search.slave, object.index, object.sub);
        if (!value && !refused(value.error())) co_return value.error();
        if (value) search.slave.kept.push_back({object.index, object.sub, *value});
    }
    co_return Result<void>{};
}

void remark(Search& search, const Pdos& pdos) {
    const auto left_out = lacking(pdos, search.wish.pdo.entries);
    search.bus.remember(fmt::format("{}: {} exchanged{}", search.slave.subject, names(pdos),
                                    left_out.empty() ? std::string{} : fmt::format("; without {}", names(left_out))));
}

}  // namespace

Script<Result<std::vector<PdoDescription>>> search_pdos(Bus& bus, BusSlave& slave, std::uint8_t sync_manager, const PdoWish& wish) {
    const std::string abort_before = slave.last_abort;
    Search search{bus, slave, assignment_of(sync_manager), wish};
    Result<Pdos> found = co_await look_for(search);
    if (!found) co_return found.error();
    if (search.out()) {
        const Result<void> kept = co_await keep_outputs(search, *found);
        if (!kept) co_return kept.error();
    }
    slave.last_abort = abort_before;  // what it did not take was a question, and explains nothing that comes later
    remark(search, *found);
    co_return found;
}

}  // namespace taktwerk::ecat
