from saleg.steady.continuation import *
