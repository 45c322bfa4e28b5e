#include "ecat/bringup/pdo_search.hpp"

#include <fmt/format.h>

#include <algorithm>

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
    std::string refusal;     ///< the last thing that it did not take
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
        const std::uint32_t value = (std::uint32_t{entry.index} << 16) | (std::uint32_t{entry.sub} << 8) | entry.bits;
        const auto place = static_cast<std::uint8_t>(taken.entries.size() + 1);
        written = co_await write_number(search.bus, search.slave, taken.index, place, value, 4);
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

/// Of its own PDOs, where it takes none of ours.
Script<Result<Pdos>> choose_own(Search& search, const Pdos& now) {
    if (has_all(now, search.wish.required) && !search.assignable) co_return now;
    std::vector<std::uint16_t> numbers;
    for (const auto range : ranges)
        for (std::uint16_t n = 0; n < looked_at; ++n)
            numbers.push_back(static_cast<std::uint16_t>((search.wish.pdo.index < first_tx ? first_rx : first_tx) + range + n));
    search.bus.note(search.slave, fmt::format("looking which PDOs it has for {:04X}h", search.assignment));
    Result<Pdos> offered = co_await read_all(search, numbers);
    if (!offered) co_return offered.error();
    Pdos chosen = search.assignable ? choose(*offered, search.wish) : now;
    if (!has_all(chosen, search.wish.required) || chosen.empty()) co_return nothing_fits(search, search.assignable ? *offered : now);
    if (search.assignable) {
        const Result<void> written = co_await write_assigned(search.bus, search.slave, search.assignment, chosen);
        if (!written) co_return written.error();
    }
    co_return chosen;
}

void remark(Search& search, const Pdos& pdos) {
    const auto left_out = lacking(pdos, search.wish.pdo.entries);
    search.bus.remember(fmt::format("{}: {} exchanged{}", search.slave.subject, names(pdos),
                                    left_out.empty() ? std::string{} : fmt::format("; without {}", names(left_out))));
}

}  // namespace

Script<Result<std::vector<PdoDescription>>> search_pdos(Bus& bus, BusSlave& slave, std::uint8_t sync_manager, const PdoWish& wish) {
    Search search{bus, slave, assignment_of(sync_manager), wish, true, {}};
    const Result<std::vector<std::uint16_t>> numbers = co_await read_assignment(bus, slave, search.assignment);
    if (!numbers && !refused(numbers.error())) co_return numbers.error();
    Pdos now;
    if (numbers) {
        Result<Pdos> read = co_await read_all(search, *numbers);
        if (!read) co_return read.error();
        now = std::move(*read);
    }
    if (has_all(now, search.wish.pdo.entries)) {
        remark(search, now);
        co_return now;
    }
    const Result<void> cleared = co_await write_number(bus, slave, search.assignment, 0, 0, 1);
    if (!cleared) {
        if (!refused(cleared.error())) co_return cleared.error();
        search.assignable = false;
        search.refusal = cleared.error().what;
        if (now.size() == 1) search.wish.pdo.index = now.front().index;  // its content may be free all the same
    }
    const Result<std::optional<PdoDescription>> filled = co_await fill(search);
    if (!filled) co_return filled.error();
    Pdos result;
    if (*filled && has_all({**filled}, search.wish.required)) {
        result = {**filled};
        if (search.assignable) {
            const Result<void> written = co_await write_assigned(bus, slave, search.assignment, result);
            if (!written) co_return written.error();
        }
    } else {
        Result<Pdos> own = co_await choose_own(search, now);
        if (!own) co_return own.error();
        result = std::move(*own);
    }
    slave.last_abort.clear();  // what it did not take was a question, and explains nothing that comes later
    remark(search, result);
    co_return result;
}

}  // namespace taktwerk::ecat
