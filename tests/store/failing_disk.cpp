// SPDX-License-Identifier: Apache-2.0
#include "tests/store/failing_disk.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <utility>

#include <sqlite3.h>

namespace tinsmith::store_tests {

namespace {

constexpr std::size_t kSector = 512;

/// A write, or a new length.
struct Change {
    std::size_t offset = 0;
    std::string bytes;
    bool is_length = false;
};

void apply_change(const Change& change, std::string& content) {
    if (change.is_length) {
        content.resize(change.offset);
        return;
    }
    if (content.size() < change.offset + change.bytes.size())
        content.resize(change.offset + change.bytes.size());
    std::copy(change.bytes.begin(), change.bytes.end(),
              content.begin() + static_cast<std::ptrdiff_t>(change.offset));
}

std::string content_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

struct FailingDisk::Image {
    std::optional<std::string> safe;   ///< what is on the disk for certain; nothing: no such file
    std::vector<Change> unsafe;        ///< since then
    std::optional<std::string> ghost;  ///< removed, but the folder was not synced
    bool is_log = false;
};

// The file system's functions.

namespace {

struct File {
    sqlite3_file base;  // first: SQLite sees this alone
    FailingDisk* disk;
    std::shared_ptr<FailingDisk::Image>* image;
    sqlite3_file* real;
};

File& of(sqlite3_file* file) {
    return *reinterpret_cast<File*>(file);
}
FailingDisk& disk_of(sqlite3_vfs* vfs) {
    return *static_cast<FailingDisk*>(vfs->pAppData);
}
sqlite3_vfs* usual() {
    return sqlite3_vfs_find(nullptr);
}

int close_file(sqlite3_file* file) {
    const int code = of(file).real->pMethods->xClose(of(file).real);
    delete of(file).image;
    return code;
}
int read_file(sqlite3_file* file, void* data, int size, sqlite3_int64 offset) {
    sqlite3_file* real = of(file).real;
    return of(file).disk->read([=] { return real->pMethods->xRead(real, data, size, offset); });
}
int write_file(sqlite3_file* file, const void* data, int size, sqlite3_int64 offset) {
    sqlite3_file* real = of(file).real;
    return of(file).disk->write(**of(file).image, data, size, offset,
                                [=] { return real->pMethods->xWrite(real, data, size, offset); });
}
int truncate_file(sqlite3_file* file, sqlite3_int64 size) {
    sqlite3_file* real = of(file).real;
    return of(file).disk->truncate(**of(file).image, size,
                                   [=] { return real->pMethods->xTruncate(real, size); });
}
int sync_file(sqlite3_file* file, int) {
    return of(file).disk->sync(**of(file).image);
}
int file_size(sqlite3_file* file, sqlite3_int64* size) {
    return of(file).real->pMethods->xFileSize(of(file).real, size);
}
int lock(sqlite3_file* file, int level) {
    return of(file).real->pMethods->xLock(of(file).real, level);
}
int unlock(sqlite3_file* file, int level) {
    return of(file).real->pMethods->xUnlock(of(file).real, level);
}
int check_lock(sqlite3_file* file, int* out) {
    return of(file).real->pMethods->xCheckReservedLock(of(file).real, out);
}
int control(sqlite3_file* file, int operation, void* argument) {
    return of(file).real->pMethods->xFileControl(of(file).real, operation, argument);
}
int sector_size(sqlite3_file* file) {
    return of(file).real->pMethods->xSectorSize(of(file).real);
}
int characteristics(sqlite3_file* file) {
    return of(file).real->pMethods->xDeviceCharacteristics(of(file).real);
}
int shm_map(sqlite3_file* file, int page, int size, int extend, void volatile** out) {
    return of(file).real->pMethods->xShmMap(of(file).real, page, size, extend, out);
}
int shm_lock(sqlite3_file* file, int offset, int number, int flags) {
    return of(file).real->pMethods->xShmLock(of(file).real, offset, number, flags);
}
void shm_barrier(sqlite3_file* file) {
    of(file).real->pMethods->xShmBarrier(of(file).real);
}
int shm_unmap(sqlite3_file* file, int remove) {
    return of(file).real->pMethods->xShmUnmap(of(file).real, remove);
}

/// Version 2: with the index of the log, without mapping the file into memory.
const sqlite3_io_methods kMethods = {
    2,        close_file,  read_file,  write_file, truncate_file, sync_file,       file_size,
    lock,     unlock,      check_lock, control,    sector_size,   characteristics, shm_map,
    shm_lock, shm_barrier, shm_unmap,  nullptr,    nullptr};

int open_file(sqlite3_vfs* vfs, const char* name, sqlite3_file* file, int flags, int* out) {
    File& made = of(file);
    made.base.pMethods = nullptr;
    made.disk = &disk_of(vfs);
    made.real = reinterpret_cast<sqlite3_file*>(reinterpret_cast<char*>(file) + sizeof(File));
    std::error_code code;
    const std::string path = name == nullptr ? "" : name;
    const bool exists = std::filesystem::exists(path, code);
    std::shared_ptr<FailingDisk::Image> image;
    if (const int refused = made.disk->open(path, exists, image); refused != SQLITE_OK)
        return refused;
    const int opened = usual()->xOpen(usual(), name, made.real, flags, out);
    if (opened != SQLITE_OK) return opened;
    made.image = new std::shared_ptr<FailingDisk::Image>(std::move(image));
    made.base.pMethods = &kMethods;
    return SQLITE_OK;
}
int delete_file(sqlite3_vfs* vfs, const char* name, int synced) {
    return disk_of(vfs).remove(name, synced != 0,
                               [=] { return usual()->xDelete(usual(), name, 0); });
}
int access_file(sqlite3_vfs*, const char* name, int flags, int* out) {
    return usual()->xAccess(usual(), name, flags, out);
}
int full_name(sqlite3_vfs*, const char* name, int size, char* out) {
    return usual()->xFullPathname(usual(), name, size, out);
}
int randomness(sqlite3_vfs*, int size, char* out) {
    return usual()->xRandomness(usual(), size, out);
}
int sleep_for(sqlite3_vfs*, int microseconds) {
    return usual()->xSleep(usual(), microseconds);
}
int time_now(sqlite3_vfs*, double* out) {
    return usual()->xCurrentTime(usual(), out);
}
int last_error(sqlite3_vfs*, int, char*) {
    return 0;
}

}  // namespace

struct FailingDisk::System {
    sqlite3_vfs vfs{};
};

FailingDisk::FailingDisk(std::string name)
    : name_(std::move(name)), system_(std::make_unique<System>()) {
    sqlite3_initialize();
    sqlite3_vfs& vfs = system_->vfs;
    vfs.iVersion = 1;
    vfs.szOsFile = static_cast<int>(sizeof(File)) + usual()->szOsFile;
    vfs.mxPathname = usual()->mxPathname;
    vfs.zName = name_.c_str();
    vfs.pAppData = this;
    vfs.xOpen = open_file;
    vfs.xDelete = delete_file;
    vfs.xAccess = access_file;
    vfs.xFullPathname = full_name;
    vfs.xRandomness = randomness;
    vfs.xSleep = sleep_for;
    vfs.xCurrentTime = time_now;
    vfs.xGetLastError = last_error;
    sqlite3_vfs_register(&vfs, 0);
}

FailingDisk::~FailingDisk() {
    sqlite3_vfs_unregister(&system_->vfs);
}

void FailingDisk::fail(Work work, Fault fault, std::uint64_t after, std::uint64_t times) {
    const std::lock_guard lock(mutex_);
    plan_ = {work, fault, after, times};
    failures_ = 0;
}

void FailingDisk::mend() {
    const std::lock_guard lock(mutex_);
    plan_ = {};
}

std::uint64_t FailingDisk::failures() const {
    const std::lock_guard lock(mutex_);
    return failures_;
}

void FailingDisk::cut() {
    const std::lock_guard lock(mutex_);
    is_cut_ = true;
}

bool FailingDisk::is_cut() const {
    const std::lock_guard lock(mutex_);
    return is_cut_;
}

void FailingDisk::cut_after_syncs(std::uint64_t syncs) {
    const std::lock_guard lock(mutex_);
    syncs_to_cut_ = syncs;
}

std::uint64_t FailingDisk::syncs() const {
    const std::lock_guard lock(mutex_);
    return syncs_;
}

std::uint64_t FailingDisk::log_syncs() const {
    const std::lock_guard lock(mutex_);
    return log_syncs_;
}

/// Requires: the lock.
int FailingDisk::planned_fault(Work work) {
    if (is_cut_) return SQLITE_IOERR;
    if (plan_.times == 0 || plan_.work != work) return SQLITE_OK;
    if (plan_.after > 0) {
        --plan_.after;
        return SQLITE_OK;
    }
    --plan_.times;
    ++failures_;
    if (plan_.fault == Fault::Full) return SQLITE_FULL;
    return work == Work::Sync ? SQLITE_IOERR_FSYNC : SQLITE_IOERR_WRITE;
}

int FailingDisk::open(const std::string& path, bool exists, std::shared_ptr<Image>& image) {
    const std::lock_guard lock(mutex_);
    if (is_cut_) return SQLITE_CANTOPEN;
    auto& known = images_[path];
    if (!known) {
        known = std::make_shared<Image>();
        known->is_log = path.ends_with("-wal");
        if (exists && !path.empty()) known->safe = content_of(path);
    }
    image = known;
    return SQLITE_OK;
}

int FailingDisk::read(const std::function<int()>& really) const {
    const std::lock_guard lock(mutex_);
    return is_cut_ ? SQLITE_IOERR_READ : really();
}

int FailingDisk::write(Image& image, const void* data, int size, std::int64_t offset,
                       const std::function<int()>& really) {
    const std::lock_guard lock(mutex_);
    if (const int fault = planned_fault(Work::Write); fault != SQLITE_OK) return fault;
    const int code = really();
    if (code == SQLITE_OK) {
        const char* bytes = static_cast<const char*>(data);
        image.unsafe.push_back({static_cast<std::size_t>(offset),
                                std::string(bytes, static_cast<std::size_t>(size)), false});
    }
    return code;
}

int FailingDisk::truncate(Image& image, std::int64_t size, const std::function<int()>& really) {
    const std::lock_guard lock(mutex_);
    if (const int fault = planned_fault(Work::Write); fault != SQLITE_OK) return fault;
    const int code = really();
    if (code == SQLITE_OK) image.unsafe.push_back({static_cast<std::size_t>(size), {}, true});
    return code;
}

int FailingDisk::sync(Image& image) {
    const std::lock_guard lock(mutex_);
    if (const int fault = planned_fault(Work::Sync); fault != SQLITE_OK) {
        // The system now takes for written what is not.
        if (!is_cut_) image.unsafe.clear();
        return fault;
    }
    if (!image.safe) {
        image.safe.emplace();
        // The folder is synced with it, and so is what was removed from it.
        for (const auto& [path, other] : images_)
            other->ghost.reset();
    }
    for (const Change& change : image.unsafe)
        apply_change(change, *image.safe);
    image.unsafe.clear();
    ++syncs_;
    if (image.is_log) ++log_syncs_;
    if (syncs_to_cut_ > 0 && --syncs_to_cut_ == 0) is_cut_ = true;
    return SQLITE_OK;
}

int FailingDisk::remove(const std::string& path, bool synced, const std::function<int()>& really) {
    const std::lock_guard lock(mutex_);
    if (is_cut_) return SQLITE_IOERR_DELETE;
    const int code = really();
    if (code != SQLITE_OK) return code;
    const auto found = images_.find(path);
    if (found == images_.end()) return code;
    Image& image = *found->second;
    if (synced) {
        image.ghost.reset();
    } else if (image.safe) {
        image.ghost = std::move(image.safe);
    }
    image.safe.reset();
    image.unsafe.clear();
    return code;
}

void FailingDisk::restore(std::optional<std::uint64_t> seed) {
    const std::lock_guard lock(mutex_);
    for (auto& [path, image] : images_) {
        if (path.empty()) continue;
        put_down(path, *image, seed);
        // The index of the log is no file to the system's mind: it does not outlive it.
        std::error_code code;
        std::filesystem::remove(path + "-shm", code);
        if (seed) seed = *seed + 1;
    }
    images_.clear();
    is_cut_ = false;
    syncs_to_cut_ = 0;
    plan_ = {};
}

void FailingDisk::put_down(const std::string& path, Image& image,
                           std::optional<std::uint64_t> seed) const {
    std::optional<std::string> content = std::move(image.safe);
    std::mt19937_64 random(seed.value_or(0));
    const auto one_of = [&random](std::uint64_t number) { return random() % number; };
    // Its removal was not yet safe: with no word about it, the file is there again.
    if (!content && image.ghost && (!seed || one_of(2) == 0)) content = std::move(image.ghost);
    if (seed) {
        const std::uint64_t kept = one_of(4);  // of four: none, all, or some
        for (Change& change : image.unsafe) {
            if (kept == 0 || (kept > 1 && one_of(2) == 0)) continue;
            if (kept > 1 && !change.is_length && one_of(3) == 0) {
                const std::size_t sectors = change.bytes.size() / kSector + 1;
                const std::size_t from = one_of(sectors) * kSector;
                change.offset += std::min(from, change.bytes.size());
                change.bytes.erase(0, from);
                change.bytes.resize(
                    std::min<std::size_t>(change.bytes.size(), one_of(sectors + 1) * kSector));
            }
            if (!content) content.emplace();
            apply_change(change, *content);
        }
    }
    std::error_code code;
    std::filesystem::remove(path, code);
    if (content) std::ofstream(path, std::ios::binary) << *content;
}

}  // namespace tinsmith::store_tests
