#include "support/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <ios>
#include <random>
#include <system_error>

#include "support/error.h"

namespace goniofit {

namespace fs = std::filesystem;

namespace {

Error cannot(const std::string& what, const fs::path& path, int error_number) {
  return system_error("cannot " + what + " " + path.string() + ": " + std::strerror(error_number));
}

class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags, mode_t mode = 0) : fd_(::open(path.c_str(), flags | O_CLOEXEC, mode)) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor(Descriptor&&) = delete;
  Descriptor& operator=(Descriptor&&) = delete;
  [[nodiscard]] bool open() const noexcept { return fd_ >= 0; }
  [[nodiscard]] int get() const noexcept { return fd_; }

 private:
  int fd_;
};

// Short whatever the target is called (NAME_MAX), of the same extension (gnuplot and OpenEXR look at it), hidden.
std::string random_name(const fs::path& target) {
  constexpr std::string_view alphabet = "abcdefghijklmnopqrstuvwxyz0123456789";
  std::random_device entropy;
  std::uniform_int_distribution<std::size_t> letter(0, alphabet.size() - 1);
  std::string name = ".goniofit-";
  for (int i = 0; i < 12; ++i) name += alphabet[letter(entropy)];
  const std::string extension = target.extension().string();
  return extension.size() < 32 ? name + extension : name;
}

// A new empty file that no other writer has, removed at the end of the scope unless it was renamed away. Made with
// O_EXCL and mode 0666, so that the kernel applies the umask (which cannot be asked for without changing it under other
// threads).
class TemporaryFile {
 public:
  TemporaryFile(const fs::path& folder, const fs::path& target) {
    for (int attempt = 0; attempt < 100; ++attempt) {
      path_ = folder / random_name(target);
      const Descriptor file(path_, O_CREAT | O_EXCL | O_WRONLY, 0666);
      if (file.open()) return;
      if (errno != EEXIST) throw cannot("write", target, errno);
    }
    throw cannot("write", target, EEXIST);
  }
  ~TemporaryFile() {
    if (!path_.empty()) ::unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  TemporaryFile(TemporaryFile&&) = delete;
  TemporaryFile& operator=(TemporaryFile&&) = delete;

  [[nodiscard]] const fs::path& path() const noexcept { return path_; }
  void rename_to(const fs::path& target) {
    if (::rename(path_.c_str(), target.c_str()) != 0) throw cannot("write", target, errno);
    path_.clear();
  }

 private:
  fs::path path_;
};

// A full disk may show only here: delayed allocation reports it at fsync.
void flush_to_disk(const fs::path& file, const fs::path& target) {
  const Descriptor descriptor(file, O_RDONLY);
  if (!descriptor.open() || ::fsync(descriptor.get()) != 0) throw cannot("write", target, errno);
}

// Makes the rename itself durable. Not every file system can; the content is safe either way.
void flush_folder(const fs::path& folder) {
  const Descriptor descriptor(folder, O_RDONLY | O_DIRECTORY);
  if (descriptor.open()) (void)::fsync(descriptor.get());
}

// Devices and pipes (/dev/stdout) cannot be replaced by a rename, that would take them away: the finished content is
// copied into them.
void copy_into_device(const fs::path& file, const fs::path& device) {
  std::ifstream in(file, std::ios::binary);
  const Descriptor out(device, O_WRONLY);
  if (!out.open()) throw cannot("write", device, errno);
  std::array<char, 1 << 16> buffer;
  while (in.read(buffer.data(), buffer.size()), in.gcount() > 0) {
    for (std::streamsize done = 0; done < in.gcount();) {
      const ssize_t n = ::write(out.get(), buffer.data() + done, static_cast<std::size_t>(in.gcount() - done));
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) throw cannot("write", device, errno);
      done += n;
    }
  }
}

void write_to_device(const fs::path& device, const std::function<void(const fs::path&)>& write) {
  const TemporaryFile temporary(fs::temp_directory_path(), device);
  write(temporary.path());
  copy_into_device(temporary.path(), device);
}

// The file behind a symbolic link is replaced, not the link.
fs::path resolve(const fs::path& path) {
  std::error_code error;
  if (!fs::is_symlink(path, error)) return path;
  fs::path real = fs::weakly_canonical(path, error);
  if (error) throw cannot("write", path, error.value());
  return real;
}

}  // namespace

void write_file_with(const fs::path& path, const std::function<void(const fs::path&)>& write) {
  const fs::path target = resolve(path);
  struct stat old {};
  const bool replaces = ::stat(target.c_str(), &old) == 0;
  if (replaces && S_ISDIR(old.st_mode)) throw cannot("write", path, EISDIR);
  if (replaces && !S_ISREG(old.st_mode)) return write_to_device(target, write);
  // A rename would replace a write-protected file all the same.
  if (replaces && ::access(target.c_str(), W_OK) != 0) throw cannot("write", path, errno);

  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  TemporaryFile temporary(folder, path);
  // Before the content comes in: what was private is private at every moment.
  if (replaces && ::chmod(temporary.path().c_str(), old.st_mode & 07777) != 0) throw cannot("write", path, errno);
  write(temporary.path());
  flush_to_disk(temporary.path(), path);
  temporary.rename_to(target);
  flush_folder(folder);
}

void write_stream(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  write_file_with(path, [&](const fs::path& temporary) {
    std::ofstream out;
    // Thrown at the first failed write, while errno still says why, and before hours of work go into a full disk.
    out.exceptions(std::ios::badbit | std::ios::failbit);
    errno = 0;
    try {
      out.open(temporary, std::ios::binary | std::ios::trunc);
      write(out);
      out.close();
    } catch (const std::ios_base::failure&) {
      throw cannot("write", path, errno != 0 ? errno : EIO);
    }
  });
}

void write_file(const fs::path& path, std::string_view content) {
  write_stream(path,
               [&](std::ostream& out) { out.write(content.data(), static_cast<std::streamsize>(content.size())); });
}

}  // namespace goniofit
