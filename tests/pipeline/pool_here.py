"""A pool without workers."""

from concurrent.futures import Future

from processes import Pool


class Here(Pool):
    """Runs tasks at once, in this process."""

    size = 1

    def submit(self, function, task):
        future = Future()
        try:
            future.set_result(function(task))
        except Exception as error:
            future.set_exception(error)
        return future

    def result(self, future):
        return future.result()

    def end(self, now=False):
        pass
