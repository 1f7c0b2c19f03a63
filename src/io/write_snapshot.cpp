// SPDX-License-Identifier: Apache-2.0
#include "resect/files.hpp"

#include "io/file.hpp"
#include "io/refuse.hpp"

namespace resect {

Result<void> write_snapshot(const std::string& path, const Snapshot& snapshot) {
    return write_file(path, snapshot.bytes());
}

Result<Snapshot> load_snapshot(const std::string& path) {
    return read_or_refuse(
        [&] { return value_or_refuse(Snapshot::from_bytes(read_file(path)), path + ": "); });
}

} // namespace resect
