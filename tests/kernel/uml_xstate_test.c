// Proves uml_xstate.c on any machine: a program that keeps less of the extended state than this
// processor has, as linux.uml does on one with AMX. It is run with the library preloaded, and by
// itself with the argument "alone", to see that the host then refuses.

#include <elf.h>
#include <errno.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

enum {
  kept = 512 + 64, // the smallest part there can be
  skipped = 77,
  xmm0 = 160, // its place in the legacy region
};

static unsigned char state[kept];
static volatile long word = 0x1234567812345678;

static void expect(int holds, const char* what) {
  if (!holds) {
    fprintf(stderr, "failed: %s (errno %d)\n", what, errno);
    exit(EXIT_FAILURE);
  }
}

static long exchange(enum __ptrace_request request, pid_t task, size_t* size) {
  struct iovec part = {state, *size};
  const long result = ptrace(request, task, (void*)NT_X86_XSTATE, &part);
  *size = part.iov_len;
  return result;
}

static pid_t stopped_child(void) {
  const pid_t child = fork();
  if (child == 0) {
    ptrace(PTRACE_TRACEME, 0, NULL, NULL);
    raise(SIGSTOP);
    _exit(0);
  }
  int status = 0;
  expect(child > 0 && waitpid(child, &status, 0) == child && WIFSTOPPED(status), "a child stops");
  return child;
}

// Whether this processor has a state longer than what is kept here.
static int has_more(pid_t child) {
  static unsigned char all[1 << 16];
  struct iovec whole = {all, sizeof all};
  expect(ptrace(PTRACE_GETREGSET, child, (void*)NT_X86_XSTATE, &whole) == 0, "all is read");
  return whole.iov_len > kept;
}

static void check_part(pid_t child) {
  size_t size = kept;
  expect(exchange(PTRACE_GETREGSET, child, &size) == 0 && size == kept, "a part is read");
  uint64_t features = 0;
  memcpy(&features, state + 512, sizeof features);
  expect((features & ~UINT64_C(0x2FF)) == 0, "no unknown part is claimed to be there");
  features = 3; // x87 and SSE
  memcpy(state + 512, &features, sizeof features);
  memset(state + xmm0, 0x5A, 16);
  expect(exchange(PTRACE_SETREGSET, child, &size) == 0, "a part is written");
  memset(state, 0, sizeof state);
  expect(exchange(PTRACE_GETREGSET, child, &size) == 0, "it is read again");
  expect(state[xmm0] == 0x5A && state[xmm0 + 15] == 0x5A, "what was written is there");
}

static void check_others(pid_t child) {
  errno = EDOM;
  expect(ptrace(PTRACE_PEEKDATA, child, (void*)&word, NULL) == word && errno == 0, "a word");
  expect(ptrace(PTRACE_PEEKDATA, child, NULL, NULL) == -1 && errno == EIO, "no word");
  expect(ptrace(PTRACE_POKEDATA, child, (void*)&word, (void*)5) == 0, "a word is written");
  expect(ptrace(PTRACE_PEEKDATA, child, (void*)&word, NULL) == 5, "it is the child's");
  expect(ptrace(PTRACE_CONT, child, NULL, NULL) == 0, "the child goes on");
}

int main(int argc, char** argv) {
  const pid_t child = stopped_child();
  if (!has_more(child)) {
    puts("skipped: this processor has no more extended state than the smallest");
    kill(child, SIGKILL);
    return skipped;
  }
  if (argc > 1 && strcmp(argv[1], "alone") == 0) {
    size_t size = kept;
    expect(exchange(PTRACE_GETREGSET, child, &size) == 0, "the host gives a part");
    expect(exchange(PTRACE_SETREGSET, child, &size) == -1 && errno == EFAULT, "it takes no part");
    kill(child, SIGKILL);
    return EXIT_SUCCESS;
  }
  check_part(child);
  check_others(child);
  int status = 0;
  expect(waitpid(child, &status, 0) == child && WIFEXITED(status), "it ends well");
  return EXIT_SUCCESS;
}
