#pragma once
// What every room of a machine reads: the configuration, the bus, the points, the axes, the alarms, and the state of the cycle. Beside each
// stands who writes it; nobody else does. Private to runtime/machine/.

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "axes/axis/axis.hpp"
#include "axes/group/axis_groups.hpp"
#include "core/recorder.hpp"
#include "ecat/master.hpp"
#include "runtime/alarms.hpp"
#include "runtime/machine/alarm_log.hpp"
#include "runtime/machine/kept_points.hpp"
#include "runtime/machine_config.hpp"
#include "runtime/recording/recorded_transport.hpp"
#include "runtime/snapshot.hpp"
#include "runtime/tasks/io_image.hpp"
#include "runtime/tasks/watched_requests.hpp"

namespace taktwerk::runtime {

struct MachineBody {
    MachineBody(MachineConfig machine, ecat::Transport& transport);
    MachineBody(const MachineBody&) = delete;
    MachineBody& operator=(const MachineBody&) = delete;

    /// Its condition holds in this cycle. Real-time safe.
    void raise(MachineAlarm alarm, AlarmSource source, std::uint16_t index, double a = 0, double b = 0) noexcept;
    /// `table`: of the floor that the fact comes from. Real-time safe.
    void raise(const AlarmFact& fact, std::span<const AlarmInfo> table) noexcept;
    /// Axis::shut_down; one that its group moves comes to rest on the path first. Real-time safe.
    void shut_down(std::size_t axis) noexcept;

    const MachineConfig config;
    const ecat::BusConfig bus_config;  // config.bus, and what the axes need of the bus beyond it
    RecordedTransport wire;
    ecat::Master bus;
    IoImage io;
    const KeptPoints kept;
    axes::MotionTables tables;          // declared by the programs
    std::vector<axes::AxisView> views;  // where the axes keep theirs; what programs read
    std::vector<axes::Axis> axes;       // built by MachineDrives
    axes::AxisGroups axis_groups;       // likewise
    WatchedRequests requests;           // of operators; of programs through theirs
    AlarmLog log;
    Recorder* recorder = nullptr;  // of what the cycle takes, and what it makes of it; nullptr: nobody records
    Recorder* calls = nullptr;     // likewise, of what the cycle's thread does between two cycles
    bool threads_beside = false;   // start() and stop() of programs and slower tasks have threads of their own

    bool replayed = false;  // what comes from outside comes from a recording: nobody else is asked

    // the cycle's
    Instant now{};                                            // Machine
    std::uint64_t cycles = 0;                                 // Machine: those that are over
    std::vector<FollowingPeak> following_peaks;               // Machine: wider in each cycle; OperatorDesk: begun anew
    CycleStatistics statistics;                               // Machine; refused commands: OperatorDesk
    Mode mode;                                                // OperatorDesk
    bool emergency = false;                                   // EmergencyInputs: pressed, or its wire is broken
    bool shutting_down = false;                               // Shutdown: has begun
    std::atomic<MachinePhase> phase{MachinePhase::starting};  // Machine::arm(), then Shutdown
    std::atomic<bool> armed{false};                           // Machine::arm(): on the service side, while cycles already run
};

}  // namespace taktwerk::runtime
