// Lets User-Mode Linux 6.1 run on processors with AMX: preload it into linux.uml, and into nothing
// else (uml.sh). It replaces ptrace().
//
// The machine keeps 2,696 bytes of extended state (XSAVE: x87 to PKRU) for each of its tasks and
// writes them back by PTRACE_SETREGSET. A host with AMX has 11,008 and takes all of it or fails
// with EFAULT, whereupon the machine panics. So whoever asks for less than the host has is given
// the beginning of it, and what he writes is filled up with zeros, which is the initial state.

#include <elf.h>
#include <errno.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

enum {
  features_at = 512,    // XSTATE_BV: which parts are there (Intel SDM, volume 1, 13.4.2)
  header_end = 512 + 64 // the legacy region and the header
};

static const uint64_t known_features = 0x2FF; // x87, SSE, AVX, MPX, AVX-512 and PKRU

// Not on the stack: those of a kernel have 16 KiB, and this one is called on them. Only one
// processor's worth of kernel runs in linux.uml, so nobody else is in here at the same time.
static unsigned char whole[1 << 16];

static long raw(int request, pid_t task, void* address, void* data) {
  return syscall(SYS_ptrace, (long)request, (long)task, address, data);
}

// Reads the host's state of a task into `whole`: its length, 0 if it cannot be read.
static size_t read_whole(pid_t task, void* set) {
  struct iovec all = {whole, sizeof whole};
  return raw(PTRACE_GETREGSET, task, set, &all) == 0 ? all.iov_len : 0;
}

static void forget_unknown_features(void) {
  uint64_t features = 0;
  memcpy(&features, whole + features_at, sizeof features);
  features &= known_features;
  memcpy(whole + features_at, &features, sizeof features);
}

// GETREGSET and SETREGSET of the extended state.
static long exchange(int request, pid_t task, void* set, struct iovec* part) {
  const size_t length = read_whole(task, set);
  if (part->iov_len < header_end || length <= part->iov_len) {
    return raw(request, task, set, part);
  }
  if (request == PTRACE_GETREGSET) {
    forget_unknown_features();
    memcpy(part->iov_base, whole, part->iov_len);
    return 0;
  }
  memset(whole, 0, length);
  memcpy(whole, part->iov_base, part->iov_len);
  struct iovec all = {whole, length};
  return raw(request, task, set, &all);
}

long ptrace(enum __ptrace_request request, ...) {
  va_list arguments;
  va_start(arguments, request);
  const pid_t task = va_arg(arguments, pid_t);
  void* const address = va_arg(arguments, void*);
  void* const data = va_arg(arguments, void*);
  va_end(arguments);
  if (request == PTRACE_PEEKTEXT || request == PTRACE_PEEKDATA || request == PTRACE_PEEKUSER) {
    // The system call stores the word; callers of the function expect it to be returned.
    long word = -1;
    if (raw((int)request, task, address, &word) == -1) {
      return -1;
    }
    errno = 0;
    return word;
  }
  const int is_exchange = request == PTRACE_GETREGSET || request == PTRACE_SETREGSET;
  if (is_exchange && (uintptr_t)address == NT_X86_XSTATE) {
    return exchange((int)request, task, address, data);
  }
  return raw((int)request, task, address, data);
}
