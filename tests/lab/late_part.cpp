// Loaded ahead of a program (LD_PRELOAD), it lets the processes of parts come up three seconds late.
#include <fcntl.h>
#include <string.h>
#include <unistd.h>

__attribute__((constructor)) static void come_late() {
  char line[4096] = {};
  const int file = open("/proc/self/cmdline", O_RDONLY);
  const ssize_t size = file < 0 ? 0 : read(file, line, sizeof line - 1);
  if (file >= 0) close(file);
  if (size > 0 && memmem(line, static_cast<size_t>(size), "part-worker", 11) != nullptr) sleep(3);
}
