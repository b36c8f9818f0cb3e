from saleg.plotting.fundamental import *
