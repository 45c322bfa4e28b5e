#pragma once
// The keys of a machine file, and what is read from one before names are resolved.

#include <optional>
#include <string>
#include <vector>

#include "config/machine_file/bus_tables.hpp"
#include "config/machine_file/cam_tables.hpp"
#include "config/machine_file/group_tables.hpp"
#include "config/machine_file/path_tables.hpp"
#include "config/reading/measure.hpp"
#include "hmi_bridge/hmi_config.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::config {

/// A straight line between two pairs of values.
struct PointScale {
    MeasurePair from, to;
};

/// A point as it is written; what depends on its channel is put together by io_points.hpp.
struct IoEntry {
    runtime::IoPoint point;  ///< name, slave, inverted, filter
    std::string channel;     ///< name or number; empty: by `object`
    std::optional<ObjectAddress> object;
    std::optional<PointScale> scale;
    std::optional<MeasurePair> limits;
    std::optional<Measure> safe, simulated;
};

/// `4 cycles` or `4 ms`.
struct TaskPeriod {
    double cycles = 1;
    Duration time{};  ///< 0 = in cycles
};

struct TaskEntry {
    runtime::TaskConfig task;
    TaskPeriod every;
};

struct ProgramFile {
    runtime::ProgramConfig program;
    std::vector<TaskEntry> tasks;
};

/// `Pr097: 30`.
struct NamedParameter {
    std::string name;
    std::int64_t value = 0;
};

struct SerialDriveEntry {
    runtime::SerialDriveConfig drive;  ///< without profile and parameters
    std::string profile;
    std::vector<NamedParameter> parameters;
};

struct SerialLineEntry {
    runtime::SerialLineConfig line;  ///< without drives
    std::vector<SerialDriveEntry> drives;
};

struct MachineFile {
    std::int64_t version = 0;
    runtime::MachineConfig machine;  ///< without slaves, points, tasks and programs
    hmi::HmiConfig hmi;
    std::vector<SlaveEntry> slaves;
    std::vector<SerialLineEntry> serial;
    std::vector<IoEntry> inputs, outputs;
    std::vector<CamEntry> cams;
    std::vector<GroupEntry> groups;
    std::vector<PathEntry> paths;
    std::vector<ProgramFile> programs;
};

[[nodiscard]] Table<MachineFile> machine_table();

}  // namespace taktwerk::config
