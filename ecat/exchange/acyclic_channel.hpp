#pragma once
// Single datagrams for everything that is not process data: a service thread submits requests and reads answers, the cycle
// moves a few of them into one frame each time. Shared without locks: each entry's state is one atomic.
//
//     service:  auto id = channel.submit(Command::FPRD, Address::physical(0x1001, reg::al_status), 2);
//               if (auto answer = channel.poll(*id)) { ...; channel.release(*id); }
//     cycle:    exchange.receive(now); channel.collect(now);  ...process data...  channel.pack(now, 4);
//
// Entries leave in the order of their submission; one that waits for its gate is passed by those behind it. There are fewer entries than
// a long bus has slaves: whoever finds none stands in line (Turn), and entries go to those who came first.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "core/time.hpp"
#include "ecat/exchange/exchange.hpp"

namespace taktwerk::ecat {

/// A request. Valid until release().
struct EntryId {
    std::uint8_t entry = 0;
    std::uint32_t generation = 0;  ///< 0 = none
    friend bool operator==(EntryId, EntryId) = default;
};

/// What a request waits for before it leaves. Nothing: it leaves at once.
struct SendGate {
    const std::atomic<std::uint64_t>* word = nullptr;  ///< leaves only while this bit is set; outlives the request
    unsigned bit = 0;
    EntryId behind{};  ///< leaves only in a later frame than this request, however that one ends
    [[nodiscard]] bool exists() const noexcept { return word != nullptr || behind.generation != 0; }
};

class AcyclicChannel;

/// A place in the line for an entry. Service side; lives as long as it is wanted, and leaves the line when it goes.
class EntryTurn {
public:
    EntryTurn() = default;
    ~EntryTurn() { leave(); }
    EntryTurn(const EntryTurn&) = delete;
    EntryTurn& operator=(const EntryTurn&) = delete;

private:
    friend class AcyclicChannel;
    void leave() noexcept;

    AcyclicChannel* channel_ = nullptr;  ///< null: not in line
    EntryTurn *ahead_ = nullptr, *behind_ = nullptr;
    bool gated_ = false;
};

/// How a request ended.
struct AcyclicAnswer {
    bool lost = false;  ///< no answer within the timeout, or the link did not take the frame
    std::uint16_t wkc = 0;
    std::uint16_t slaves_passed = 0;  ///< AP and B commands: how many slaves the datagram passed
    std::span<const std::byte> data;  ///< valid until release(); empty when lost
    Instant sent_at{};                ///< when its frame left; not set when lost
};

class AcyclicChannel {
public:
    static constexpr std::size_t entry_count = 96;
    static constexpr std::size_t max_frames = 4;  ///< frames under way at the same time
    static constexpr std::size_t max_datagrams_a_frame = 48;
    static constexpr std::size_t max_gated = entry_count / 2;  ///< requests with a gate; the others must not run out of entries

    /// `exchange` outlives the channel. Allocates here. `timeout`: after it a frame's requests are lost.
    explicit AcyclicChannel(Exchange& exchange, Duration timeout = std::chrono::milliseconds{20});
    ~AcyclicChannel();
    AcyclicChannel(const AcyclicChannel&) = delete;
    AcyclicChannel& operator=(const AcyclicChannel&) = delete;

    // --- service side: one thread; allocation-free, never blocks -------------------------------------------------------------
    /// A command that carries data. Nothing when all entries are taken or the data is longer than max_datagram_data.
    [[nodiscard]] std::optional<EntryId> submit(Command command, Address address, std::span<const std::byte> data) noexcept;
    /// A command that only reads `size` bytes.
    [[nodiscard]] std::optional<EntryId> submit(Command command, Address address, std::size_t size) noexcept;
    /// Either, when its gate opens. Nothing also when max_gated of them exist.
    [[nodiscard]] std::optional<EntryId> submit_gated(Command command, Address address, std::span<const std::byte> data,
                                                      const SendGate& gate) noexcept;
    /// In line with others: nothing until it is this one's turn. The first call takes a place behind all who wait.
    [[nodiscard]] std::optional<EntryId> submit_in_turn(EntryTurn& turn, Command command, Address address, std::span<const std::byte> data,
                                                        const SendGate& gate) noexcept;
    /// How many entries were ever handed out: while this number stands still, so does the line.
    [[nodiscard]] std::uint64_t handed_out() const noexcept { return order_; }
    /// Takes a request back that has not left, and gives its entry back. False: it has left, or is stale.
    [[nodiscard]] bool withdraw(EntryId id) noexcept;
    /// Nothing while it is under way; then the answer, as often as asked, until release(). A stale id reads as lost.
    [[nodiscard]] std::optional<AcyclicAnswer> poll(EntryId id) const noexcept;
    /// Gives the entry back, also while it is under way (its answer is then dropped).
    void release(EntryId id) noexcept;
    /// Entries that are not free.
    [[nodiscard]] std::size_t in_use() const noexcept;

    // --- cycle side: one thread; real-time safe --------------------------------------------------------------------------------
    /// Puts at most `max_datagrams` waiting requests into one frame and sends it. Returns how many.
    std::size_t pack(Instant now, std::size_t max_datagrams) noexcept;
    /// Completes the requests whose frames were answered (after Exchange::receive) or timed out.
    void collect(Instant now) noexcept;

private:
    enum class State : std::uint8_t { free, filling, submitted, in_flight, abandoned, done, lost };
    struct Entry;
    struct Flight;
    [[nodiscard]] Entry* find(EntryId id) const noexcept;
    std::optional<EntryId> claim(Command command, Address address, std::size_t size, std::span<const std::byte> data,
                                 const SendGate& gate) noexcept;
    [[nodiscard]] std::size_t gated() const noexcept;
    /// By the cycle: nothing keeps the request from leaving.
    [[nodiscard]] bool open(const Entry& entry) const noexcept;
    void finish(std::size_t entry, State outcome) noexcept;
    friend class EntryTurn;
    /// Service side: nobody who could take an entry now stands before it.
    [[nodiscard]] bool turn_of(const EntryTurn& turn) const noexcept;

    Exchange& exchange_;
    Duration timeout_;
    std::unique_ptr<std::array<Entry, entry_count>> entries_;
    std::unique_ptr<std::array<Flight, max_frames>> flights_;
    std::uint64_t order_ = 0;                                       ///< service side
    EntryTurn *first_in_line_ = nullptr, *last_in_line_ = nullptr;  ///< service side
    std::uint64_t packs_ = 0;                                       ///< cycle side: pack() calls
};

}  // namespace taktwerk::ecat
