/* Preloaded into a program, and so into its children: every call that opens or connects a socket, or looks up a name, is
 * refused, and noted in the file that REFLCOLOR_SOCKETS names, with the test that runs. */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <netdb.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

static int refused(const char *call)
{
    char line[1024];
    const char *test = getenv("PYTEST_CURRENT_TEST");
    int size = snprintf(line, sizeof line, "%s%s%s\n", call, test ? " in " : "", test ? test : "");
    int log = open(getenv("REFLCOLOR_SOCKETS"), O_WRONLY | O_APPEND | O_CREAT, 0600);
    if (size >= (int)sizeof line)
        size = sizeof line - 1;
    if (log < 0 || write(log, line, size) < 0)
        abort();
    close(log);
    errno = EACCES;
    return -1;
}

int socket(int domain, int type, int protocol) { return refused("socket"); }
int socketpair(int domain, int type, int protocol, int ends[2]) { return refused("socketpair"); }
int connect(int end, const struct sockaddr *to, socklen_t size) { return refused("connect"); }
int getaddrinfo(const char *node, const char *service, const struct addrinfo *hints, struct addrinfo **found)
{
    refused("getaddrinfo");
    return EAI_FAIL;
}
