#pragma once
// The run from its start, small and in memory, so that what stopped the machine can be replayed: on an alarm that stops something, or when somebody
// asks, it is kept as a file, up to `after` behind that moment. What comes later in the run is put behind it in the same file. Where the memory
// is full the file takes what is there before anybody asks, and goes at the end of a run in which nobody did.
//
//     service side: look(snapshot) again and again, keep();   a thread that may wait for a disk: take(), work() again and again, finish() last
//
// Why from the start: the whole state of a machine cannot be written down (docs/replay.md).

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "core/alarm.hpp"
#include "core/result.hpp"
#include "core/time.hpp"
#include "runtime/new_alarms.hpp"
#include "runtime/recording_file/recording_file.hpp"
#include "runtime/run_memory/block_queue.hpp"

namespace taktwerk::runtime {

inline constexpr std::string_view replay_ending = ".twrec";

class RunMemory {
public:
    struct Room {
        std::uint64_t memory = 0;  ///< bytes of blocks, then they go to the disk
        std::uint64_t disk = 0;    ///< bytes of all files of this machine's runs; the oldest go
        std::size_t files = 0;     ///< so many of them
    };
    struct Place {
        std::string machine, folder;
        Instant start{};   ///< machine time of the run's start
        Duration epoch{};  ///< calendar time at machine time 0
        Duration after{};  ///< what is kept behind an alarm
    };
    using NameOf = std::function<std::string(const AlarmFact&)>;  ///< "drive_fault"

    /// Makes the folder, and takes away what a killed run left unfinished in it. Errors: recording.directory.
    [[nodiscard]] static Result<std::unique_ptr<RunMemory>> open(RecordingInfo info, Place place, Room room);

    // --- service side: nothing in it waits -----------------------------------------------------------------------------------------
    void look(const Snapshot& snapshot, const NameOf& name_of);
    /// The run up to now, however it goes on; gives the path that it will have. Errors: recording.ended, where it is taken no further: what came before
    /// lost records is kept all the same.
    [[nodiscard]] Result<std::string> keep(Instant now);
    struct State {
        Duration covered{};  ///< from the run's start
        std::uint64_t memory = 0, disk = 0;
        std::string file;            ///< where the run is kept, or will be once `waits` is over; empty: nowhere
        bool waits = false;          ///< its last seconds are still to come
        bool asked_waits = false;    ///< what somebody has asked for is not there yet
        std::optional<Error> ended;  ///< nothing more is taken, and why
    };
    [[nodiscard]] State state() const;

    // --- a thread that may wait ------------------------------------------------------------------------------------------------------
    /// The next block of the run; `until`: of its last record. `lost`: records that did not get into the ring so far.
    void take(const PackedBlock& block, Instant until, std::uint64_t lost);
    struct Kept {
        std::string path;  ///< empty: nothing was due
        std::string why;   ///< the alarm; empty: somebody asked
        Duration covered{};
        std::uint64_t bytes = 0;
    };
    /// What is due. Errors: recording.write, recording.limit, recording.lost: the run is taken no further, and this is said once; recording.ended: what
    /// was asked for cannot be kept any more. Of a run that lost records what came before them is kept, and an alarm in it is one that can be replayed.
    [[nodiscard]] Result<Kept> work();
    /// After the last block, once: what is still wished, and what nobody wished goes.
    [[nodiscard]] Result<Kept> finish();

private:
    struct Wish {
        std::string why;
        Instant at{}, until{};  ///< the moment that it is about, and what shall be kept
    };
    RunMemory(RecordingInfo info, Place place, Room room) : info_(std::move(info)), place_(std::move(place)), room_(room) {}
    /// The earliest first: what somebody asks for does not wait for what comes behind an alarm. Mutex held.
    void wish(Wish more);
    /// Records were lost, and what came before them is still here or in a file without a name. Mutex held.
    [[nodiscard]] bool sound_part() const {
        return ended_ && ended_->code == "recording.lost" && (!blocks_.empty() || (on_disk_ > 0 && !kept_));
    }
    [[nodiscard]] std::string path_for(std::string_view why, Instant at) const;
    /// Its file is begun where there is none, and has all blocks.
    [[nodiscard]] Result<void> write_blocks(const std::string& path, bool wished);
    [[nodiscard]] Result<void> give_name(const std::string& path);
    void discard();
    [[nodiscard]] Result<Kept> write(const Wish& wish);
    [[nodiscard]] Error end(Error why);
    /// Mutex held.
    [[nodiscard]] Error too_late(const Wish& wish) const;
    void clean() const;
    void keep_bounds() const;

    const RecordingInfo info_;
    const Place place_;
    const Room room_;
    std::set<std::string> there_;  // files of earlier runs, as they were at the start
    NewAlarms alarms_;             // service side

    mutable std::mutex mutex_;  // of what both sides see
    BlockQueue blocks_;
    Instant until_{};
    std::deque<Wish> wishes_;
    std::optional<Error> ended_;
    std::string path_;  // of the file, once the run has its name
    std::uint64_t on_disk_ = 0;
    bool kept_ = false;     // its file has its name; the other thread reads it as well
    bool writing_ = false;  // a wish is being written

    // The thread that may wait.
    std::optional<RecordingWriter> file_;
    bool said_ = false;
};

}  // namespace taktwerk::runtime
